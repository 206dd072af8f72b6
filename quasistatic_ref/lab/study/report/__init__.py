"""The report on a store, as data.

It counts and compares rows, and measures nothing. ``figures`` draws it and ``page`` writes it.
"""
