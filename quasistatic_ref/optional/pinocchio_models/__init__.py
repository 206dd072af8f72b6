"""Models of pinocchio as bodies."""
