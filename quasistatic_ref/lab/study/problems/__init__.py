"""Quadratic programs of contact with exact answers: sets of them, made, kept, checked, exported."""
