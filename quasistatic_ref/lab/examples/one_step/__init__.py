"""Single steps: what the quadratic program of a step is, and what its answer says.

Runs of many steps are in the other folders.
"""
