"""Numbers without rounding: their algebra, mechanisms in them, and what float64 can reach.

It knows numbers and tolerances. Formulas of the model are those of the plain program.
"""
