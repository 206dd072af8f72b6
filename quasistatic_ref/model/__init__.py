"""What exists: bodies and robots from URDF, their coordinates, masses and kinematics."""
