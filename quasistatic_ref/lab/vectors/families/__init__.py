"""Scenes, mechanisms and contacts at random or by hand: what new cases are made of."""
