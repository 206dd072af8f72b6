"""Friction of a contact and of a patch: cones, laws, and the artifacts of the model.

Forces of several contacts that hold a body are in ``grasps``.
"""
