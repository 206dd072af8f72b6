"""Objects shown in words and as HTML, tables, figures and the viewer."""
