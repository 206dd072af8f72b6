"""Runs that are saved and resumed."""
