"""What is done with the core: vectors, studies, claims, examples. The core imports nothing here."""
