"""Closest points of two shapes, in closed form or by search, in exact numbers.

They are the expected answers of the distances, with algorithms of their own. The plain program and
the package compute these distances in other ways.
"""
