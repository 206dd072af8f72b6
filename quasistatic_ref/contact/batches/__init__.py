"""Closest points of many pairs of one kind at once: today's formulas with one axis more."""
