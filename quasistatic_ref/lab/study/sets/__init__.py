"""Sets of problems with a name and a version: files with exact answers, verified by their hash."""
