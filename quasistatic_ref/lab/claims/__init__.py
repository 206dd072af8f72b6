"""Claims about the model, each measured against the paper, a formula or another engine.

A claim states a number and its limit. Explanations belong to the pages, and runs that only show
something to ``examples``.
"""
