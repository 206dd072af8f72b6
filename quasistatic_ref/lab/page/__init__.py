"""Reports as data, written as HTML and as Markdown."""
