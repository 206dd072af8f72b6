"""Shapes, one a file: all that concerns one shape alone."""
