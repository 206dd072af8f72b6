"""What findings look at: a scene where it starts, a run at its end, and the checks of both."""
