"""Figures of claims, studies and examples, each drawn from what was measured for it."""
