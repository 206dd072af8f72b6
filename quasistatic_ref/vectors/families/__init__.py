"""Inputs written by rule: closed forms, seeded random numbers and degenerate corners."""
