"""What a layer answers to one case, and how far from it a careful answer may be."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

Json = Any
"""What JSON holds: None, bool, int, float, str, lists and string-keyed dicts of them."""


@dataclass(frozen=True)
class Tolerance:
    """How far one field may be from the expected one.

    Parameters
    ----------
    absolute : float
        By component [the field's own unit].
    reason : str
        One clause: which rounding, by what condition of the case.
    """

    absolute: float
    reason: str


@dataclass(frozen=True)
class Expected:
    """The answer of one layer to one case.

    Parameters
    ----------
    output : dict
        Numbers are float64, rounded correctly from the exact answer; -0.0 is written 0.0.
    digits : dict
        Of fields whose exact answer is known: the same nesting, with 30-digit decimal strings
        in the place of numbers.
    flags : mapping of str to bool
        Those that apply to the layer, e.g. ``unique``.
    tolerance : mapping of str to Tolerance
        By name of the output's field.
    """

    output: dict[str, Json]
    digits: dict[str, Json] = field(default_factory=dict)
    flags: Mapping[str, bool] = field(default_factory=dict)
    tolerance: Mapping[str, Tolerance] = field(default_factory=dict)

    def json(self) -> dict[str, Json]:
        """The parts of a case in an ``expected/LAYER.json``."""
        return {
            "flags": dict(self.flags),
            "output": self.output,
            "digits": self.digits,
            "tolerance": {name: asdict(tolerance) for name, tolerance in self.tolerance.items()},
        }
