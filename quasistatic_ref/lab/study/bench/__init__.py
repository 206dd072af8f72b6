"""What a step costs, and what it is compared with: the tables of ``quasistatic-ref bench``."""
