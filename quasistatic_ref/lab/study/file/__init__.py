"""The study file, read."""
