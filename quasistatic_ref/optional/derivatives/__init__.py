"""Derivatives of a step through contact, smoothed steps, and steps in JAX."""
