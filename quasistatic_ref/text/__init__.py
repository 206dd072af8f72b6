"""What every folder uses of texts: plain data, quoting, JSON, objects that show themselves."""
