"""The reference beside a program that is being written: step by step, and over whole runs.

It takes steps of scenes for others, ``serve`` and ``compare``. Single cases with known answers are
in ``vectors``.
"""
