"""Findings on the steps of a run."""
