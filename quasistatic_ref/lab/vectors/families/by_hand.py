"""Cases that are written by hand, in ``LAYER.toml`` next to this file."""

import tomllib
from pathlib import Path

from quasistatic_ref.lab.vectors.expected import Json

Case = tuple[str, str, Json]
"""Id, provenance and input."""


def by_hand(layer: str) -> dict[str, Json]:
    """The tables of a layer's file, by name."""
    return tomllib.loads((Path(__file__).parent / f"{layer}.toml").read_text(encoding="utf-8"))
