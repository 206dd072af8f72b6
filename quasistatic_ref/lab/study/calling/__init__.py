"""Solvers, and the interfaces through which they are called."""
