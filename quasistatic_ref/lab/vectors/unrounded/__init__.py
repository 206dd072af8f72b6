"""The whole step without rounding between its layers, and its derivatives by differences."""
