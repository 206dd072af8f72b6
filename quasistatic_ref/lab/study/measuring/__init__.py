"""Calls in processes of their own, timed and graded; studies and sequences run; grids of runs.

It makes rows. They are kept by ``store`` and compared by ``report``.
"""
