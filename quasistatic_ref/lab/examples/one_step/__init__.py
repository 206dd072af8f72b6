"""Single steps: what the program of a step is, and what its answer says.

Runs of many steps are in the other folders.
"""
