"""The same steps in compiled code: optional, equal to the last bit; nobody needs to read it.

Whatever comes from here is equal to the last bit to what NumPy and python-flint give without it.
"""
