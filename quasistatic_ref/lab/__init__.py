"""What is done with the core: vectors, studies, claims, examples. The core imports nothing here.

Each folder says in two sentences what it is for and what it is not. A *program* is here what
computes the layers of the model: the plain one in ``program``, or one of another author. What a
solver solves is a problem.
"""
