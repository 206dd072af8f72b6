"""What is done with the core: vectors, studies, claims, examples. The core imports nothing here.

Each folder says in two sentences what it is for and what it is not.
"""
