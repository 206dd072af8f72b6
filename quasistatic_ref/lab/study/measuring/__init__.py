"""Calls in processes of their own, timed and graded; studies, sweeps and sequences run."""
