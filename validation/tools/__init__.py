"""Checks of the checkout itself: what CI runs that is no test of the package."""
