"""The report on a store, as data."""
