"""C functions, and how they are compiled and loaded."""
