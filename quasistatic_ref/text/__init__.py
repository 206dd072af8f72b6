"""What every folder uses of texts: plain data, quoting, JSON, fields of files, pages."""
