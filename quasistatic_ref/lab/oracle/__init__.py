"""What the reference answers where another program takes steps: ``serve``, one step at a time.

Single cases with known answers are in ``vectors``.
"""
