"""Findings on a scene where it starts."""
