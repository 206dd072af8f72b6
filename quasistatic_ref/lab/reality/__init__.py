"""The model against measurements: friction identified from loads, pushes and tripods predicted."""
