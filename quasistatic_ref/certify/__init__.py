"""The judge: what an answer is worth, decided without the solver that gave it."""
