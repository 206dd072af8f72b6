"""MJCF models as bodies."""
