"""URDF files: read, compared with what pinocchio loaded, refused in one sentence."""
