"""The command ``quasistatic-ref``."""
