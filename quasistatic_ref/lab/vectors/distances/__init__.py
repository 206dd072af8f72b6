"""Closest points of two shapes, in closed form or by search, in exact numbers."""
