"""Words of commands and files about problems; to know them nothing heavy is imported."""

RAW = "raw"
NATURAL = "natural"
UNITS = (RAW, NATURAL)
"""SI units, and those in which numbers are near one."""
