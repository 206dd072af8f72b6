"""The grasp with other clouds of the same bunny: samplings, runs, and what became of them."""
