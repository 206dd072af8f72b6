"""Reading and writing: files, fields, tables of fields, NPZ, schemas, quoting."""
