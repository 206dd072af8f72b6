"""Closed forms of the model, each derived in docs/derivations.md."""
