"""Figures with matplotlib, which is imported in this room only."""
