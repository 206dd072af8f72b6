"""What an implementation passed, said exactly: a page, a badge, a record.

It repeats the verdicts of ``check`` and adds none.
"""
