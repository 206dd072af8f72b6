"""Derivatives of a step through contact by differences of exact steps, and steps in JAX."""
