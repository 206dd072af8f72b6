"""What pairs, bodies and joints did in a run, as numbers and lines."""
