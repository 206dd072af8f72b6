"""The duality gap of multipliers in a file, and whether it is next to nothing."""

import math
from collections.abc import Sequence

from flint import fmpq

from quasistatic_ref.exact.program import ExactProgram, fraction
from quasistatic_ref.numbers.precision import nearest_fraction
from quasistatic_ref.optional.ellipsoid.tolerances import IMPULSES
from quasistatic_ref.optional.gap import energy, free_energy


def rounded_up(gap: fmpq) -> float:
    """A gap as the smallest float64 that is not below it [N m s]."""
    value = nearest_fraction(gap)
    below = math.isfinite(value) and fraction(value) < gap
    return math.nextafter(value, math.inf) if below else value


def negligible(form: ExactProgram, x: Sequence[fmpq], gap: fmpq) -> bool:
    """Whether a duality gap is mere rounding of the step's energies, with contacts and without."""
    return bool(gap <= fraction(IMPULSES) * (free_energy(form) + energy(form, x)))
