"""What was measured, kept: rows in SQLite or packed, continued and merged.

It keeps rows as they came. Whether they are right was decided in ``measuring``.
"""
