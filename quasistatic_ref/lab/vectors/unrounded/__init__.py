"""The whole step without rounding between its layers, and its derivatives by differences.

It makes the expected answers of the layer ``derivative`` alone. Those of ``step`` are rounded from
layer to layer, as a program would round them.
"""
