"""Targets in space, written as targets of joints, by inverse kinematics."""
