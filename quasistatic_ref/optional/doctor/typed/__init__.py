"""Findings on numbers as they are typed."""
