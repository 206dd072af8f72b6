"""Numbers without rounding: their algebra, mechanisms in them, and what float64 can reach."""
