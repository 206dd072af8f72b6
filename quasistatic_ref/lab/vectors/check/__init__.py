"""The checker: answers of others against what is expected, and which mistake they show."""
