"""Steps and bodies that vectors, studies, claims, examples and tests are made with."""
