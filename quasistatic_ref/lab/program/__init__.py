"""The layers of the model in plain NumPy, written from the README of the vectors alone.

This folder imports nothing but NumPy and itself: copied alone, it answers the vectors. Run it by
``python -m program VECTORS ANSWERS [LAYER ...]`` from the folder that it lies in; without
arguments it answers a challenge, line by line.
"""
