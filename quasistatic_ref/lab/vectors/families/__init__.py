"""Inputs written by rule (closed forms, seeded random numbers, corners) and from scenarios."""
