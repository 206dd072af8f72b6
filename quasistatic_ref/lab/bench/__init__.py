"""What a step costs: the six figures of ``quasistatic-ref bench``, and the parts of a step."""
