"""Derivatives of the optimum of one step by its data."""
