"""Scenario files: read, checked, and made into a system with its contacts and targets."""
