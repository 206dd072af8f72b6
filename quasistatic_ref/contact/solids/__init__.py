"""Closest points of two solids."""
