"""What the reference answers where another program takes steps: one by one, and over whole runs.

It takes steps of scenes for others, ``serve`` and ``compare``. Single cases with known answers are
in ``vectors``.
"""
