"""Arrays, ordered sums, pivots, precision and angles: numerics that several folders need."""
