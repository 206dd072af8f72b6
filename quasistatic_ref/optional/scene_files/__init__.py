"""Scenes made in Python, written as files."""
