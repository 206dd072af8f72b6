"""Closed forms of the model, each derived in docs/derivations.md.

A claim here needs no other engine and no measurement.
"""
