"""The package's own float64 answers, put together from a case's tables.

It translates and calls the package. No formula of the model is written here again.
"""
