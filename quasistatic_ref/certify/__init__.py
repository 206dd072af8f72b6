"""The judge: proves or refutes the answer of a step without the solver that gave it."""
