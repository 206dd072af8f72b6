"""What the paper claims, and what this implementation comes to.

What follows from its equations and is not said there is in ``closed_forms``.
"""
