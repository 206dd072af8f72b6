"""Numbers without rounding: their algebra, mechanisms in them, and what float64 can reach.

It knows numbers, and how well float64 can know them. Formulas of the model are those of the plain
program.
"""
