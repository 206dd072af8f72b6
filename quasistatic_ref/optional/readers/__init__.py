"""Further formats of files: clouds in PLY, PCD and NumPy's arrays."""
