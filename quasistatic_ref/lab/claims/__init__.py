"""Claims about the model, each measured against the paper, a formula or another engine."""
