"""What a step costs, and what it is compared with: the tables of ``quasistatic-ref bench``.

It measures this package. A comparison of solvers is a study, with a file and a store of its own.
"""
