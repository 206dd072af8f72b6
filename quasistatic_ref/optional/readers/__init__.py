"""Meshes, and further formats of clouds: PLY, PCD, LAS and NumPy's arrays."""
