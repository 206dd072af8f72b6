"""Steps in sequence: the simulator, its targets and its trajectories."""
