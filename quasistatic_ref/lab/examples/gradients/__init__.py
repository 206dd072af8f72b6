"""Derivatives of steps: what they are, where there are none, and a plan made by them.

How they are computed is in ``optional/derivatives``.
"""
