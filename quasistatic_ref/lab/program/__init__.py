"""The layers of the model in plain NumPy, written from the README of the vectors alone.

This folder imports nothing but NumPy and itself: copied alone, it answers the vectors. Run it by
``python -m program VECTORS ANSWERS [LAYER ...]`` from the folder that it lies in; without
arguments it answers a challenge, line by line.

It is independent of the core, which shares no line with it. The expected answers of most committed
cases were once its formulas in exact numbers; those of distances and optima were not.
"""
