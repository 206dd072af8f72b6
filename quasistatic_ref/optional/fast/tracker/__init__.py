"""Closest points of clouds that are followed from step to step."""
