"""The model against measurements: friction identified from loads, pushes predicted.

It compares, and changes nothing of the model. No coefficient is fitted to the measurements that
are then predicted.
"""
