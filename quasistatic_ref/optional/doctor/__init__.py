"""What a run shows of the model's artifacts, in words."""
