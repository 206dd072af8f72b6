"""Reports as data, written as HTML and as Markdown.

It knows sections, tables and pictures. What they say is written by the reports that use it.
"""
