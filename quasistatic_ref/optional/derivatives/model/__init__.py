"""Derivatives of masses, gravity and Jacobians by q."""
