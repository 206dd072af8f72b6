"""What a step costs, and what it is compared with: the tables of ``quasistatic-ref bench``.

It measures this package: the parts of a step in ``profile``. A comparison of solvers is a study,
with a file and a store of its own.
"""
