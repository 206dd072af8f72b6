"""The package's own float64 answers, put together from a case's tables."""
