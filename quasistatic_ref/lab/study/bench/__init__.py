"""What a step costs, beside what it is compared with: the tables of ``quasistatic-ref bench``."""
