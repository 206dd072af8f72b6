"""Closest points, Jacobians, masses and motions of bodies, before any force.

Nothing is solved here but to show what these numbers are for.
"""
