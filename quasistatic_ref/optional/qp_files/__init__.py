"""Quadratic programs of others in files."""
