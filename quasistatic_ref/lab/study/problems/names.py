"""Words of commands and files about problems; to know them nothing heavy is imported."""

from typing import Final

RAW, NATURAL = UNITS = ("raw", "natural")
"""SI units, and those in which numbers are near one."""
PARQUET: Final = "parquet"
QPS: Final = "qps"
FORMATS: Final = ("npz", PARQUET, "mat", "json", QPS)
"""Of exports."""
