"""Findings on what a run was made for."""
