"""The commands of the lab, one a file; ``cli/main.py`` imports the one that is named.

A command reads options and prints. What it calls lives in the folder of its subject, and so do
its tests.
"""
