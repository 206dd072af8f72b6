"""Constraints and costs of a user's own, written in CVXPY."""
