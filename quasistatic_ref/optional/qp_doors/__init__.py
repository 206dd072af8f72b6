"""Exact answers in programs that call CVXPY or qpsolvers: each has ``exact`` as a solver."""
