"""Reading and writing: scenarios, URDF, meshes, clouds, tables, solutions and trajectories."""
