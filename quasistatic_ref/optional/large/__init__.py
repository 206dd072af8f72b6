"""Steps with many bodies: sparse data, solvers and bounds of the error in float64."""
