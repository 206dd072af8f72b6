"""Derivatives of closest points, and the kinks at which there are none."""
