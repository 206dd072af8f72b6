"""Backends of CVXPY called sooner, by the map that it has compiled, to the same bits."""
