"""What is left of a run: its arrays, header and trajectory, motions read of it, and early ends."""
