"""What users add to a step, constraints and costs written in CVXPY, and what they solve it with."""
