"""The commands of the lab, one a file; ``cli/main.py`` imports the one that is named."""
