"""The proof of a guessed working set, in ball arithmetic."""
