"""What exists: bodies and robots from URDF, their coordinates and their shapes."""
