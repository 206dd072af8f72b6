"""Findings: what is wrong with a scene or a run."""
