"""Doors, pegs, robots and hands in scenarios that come along.

Each runs a scenario of ``models/``; none makes bodies of its own.
"""
