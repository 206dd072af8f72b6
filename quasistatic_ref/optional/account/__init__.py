"""What happened in a run, and whether its task failed."""
