"""DAQP by its own interface, kept between steps: ``backend = "daqp"``, and ``fast = true``."""
