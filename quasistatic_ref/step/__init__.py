"""One step of the model: plain arrays in, plain arrays out. No robotics stack."""
