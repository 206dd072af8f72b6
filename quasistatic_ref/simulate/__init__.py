"""Steps in sequence: scenarios, targets, the simulator and its trajectories."""
