"""Further formats of files: clouds in PLY and PCD, meshes in COLLADA."""
