"""Calls in processes of their own, timed and graded; studies, sweeps and sequences run.

It makes rows. They are kept by ``store`` and compared by ``report``.
"""
