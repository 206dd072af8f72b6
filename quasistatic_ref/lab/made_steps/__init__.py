"""Steps and bodies that vectors, studies, claims, examples and tests are made with.

They are made in Python and have no files. Scenarios that users run are in ``models/``.
"""
