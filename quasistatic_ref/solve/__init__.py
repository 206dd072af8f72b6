"""Asking a solver for the answer of a step."""
