"""Meshes, and further formats of clouds: PLY, PCD and NumPy's arrays."""
