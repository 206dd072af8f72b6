"""What an implementation passed, said exactly: a page, a badge, a record."""
