"""Shapes, one a file: distance, support, corners, normals, surface and words of each."""
