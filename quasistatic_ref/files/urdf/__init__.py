"""URDF files: read on their own, and refused in one sentence."""
