"""Words of commands and files about problems; to know them nothing heavy is imported."""

from typing import Final

RAW: Final = "raw"
NATURAL: Final = "natural"
UNITS: Final = (RAW, NATURAL)
"""SI units, and those in which numbers are near one."""
PARQUET: Final = "parquet"
QPS: Final = "qps"
FORMATS: Final = ("npz", PARQUET, "mat", "json", QPS)
"""Of exports."""
