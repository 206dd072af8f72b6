"""Claims about measurements."""
