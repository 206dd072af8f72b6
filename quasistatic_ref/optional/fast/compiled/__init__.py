"""The same steps in compiled code: optional, equal to the last bit; nobody needs to read it."""
