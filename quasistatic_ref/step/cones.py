"""The friction cones by name: how many rows each gives to a contact, and what they are called.

What the rows are is in :mod:`~quasistatic_ref.step.friction`. A contact whose ``rows`` is 4 does
not use mu_omega, and has only the leading rows. The ellipsoid is no polyhedron; a contact in it has
four multipliers.
"""

from dataclasses import dataclass
from decimal import Decimal, localcontext
from functools import cache

import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.formats.quoting import nearest_name
from quasistatic_ref.step.arrays import Indices

PYRAMID, ELLIPSOID = "pyramid", "ellipsoid"
CONES = (PYRAMID, ELLIPSOID, "product", "facets-K", "frictionless")
MOST_FACETS = 1024
"""A polygon with more sides is within 5e-6 of the circle, and makes steps of many MB."""

PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494")


@dataclass(frozen=True)
class Cone:
    """One friction cone.

    Parameters
    ----------
    name : str
    row_names : tuple of str
        A name for each number of lam that a contact with torsion has.
    short : int
        How many of these numbers a contact has whose mu_omega is not used.
    """

    name: str
    row_names: tuple[str, ...]
    short: int

    @property
    def polyhedral(self) -> bool:
        """Whether the cone is described by linear inequalities (rows) alone."""
        return self.name != ELLIPSOID

    def counts(self, rows: Indices) -> Indices:
        """How many multipliers each contact has, from its ``rows``, shape (n_c,)."""
        return np.where(rows == 6, len(self.row_names), self.short)


@cache
def cone(name: str) -> Cone:
    """The cone of a name.

    Parameters
    ----------
    name : str
        ``"pyramid"``, ``"ellipsoid"``, ``"product"``, ``"facets-K"`` with K even and at least 4,
        e.g. ``"facets-8"``; or ``"frictionless"``.

    Raises
    ------
    StepDataError
        If there is no such cone.
    """
    sliding, spin = ("+d1", "+d2", "-d1", "-d2"), ("+spin", "-spin")
    named = {
        PYRAMID: (sliding + spin, 4),
        ELLIPSOID: (("n", "d1", "d2", "spin"), 4),
        "product": (tuple(d + s for s in spin for d in sliding), 4),
        "frictionless": (("n",), 1),
    }
    if name in named:
        return Cone(name, *named[name])
    prefix, _, sides = str(name).partition("-")
    if prefix == "facets" and sides.isascii() and sides.isdecimal() and str(int(sides)) == sides:
        K = int(sides)
        if K % 2 == 0 and 4 <= K <= MOST_FACETS:
            return Cone(name, tuple(f"side {k}" for k in range(K)) + spin, K)
    problem = f"must be one of {', '.join(CONES)}, with K even and 4 to {MOST_FACETS}"
    raise StepDataError(f"{problem}{nearest_name(str(name), CONES)}", field="cone", value=name)


def direction(k: int, K: int) -> tuple[float, float]:
    """(cos, sin) of k/K of a turn, rounded correctly to float64.

    Each is therefore a definite number on every machine, quarter turns and reflections are exact,
    and K = 4 gives 0 and 1.

    Examples
    --------
    >>> direction(1, 4), direction(4, 8), direction(1, 8)[0] == direction(1, 8)[1]
    ((0.0, 1.0), (-1.0, 0.0), True)
    """
    octant, rest = divmod(8 * k, K)
    octant %= 8
    within = rest if octant % 2 == 0 else K - rest  # from the nearest axis, 0 .. 1/8 of a turn
    c, s = _cos_sin(Decimal(within) / (8 * K) * 2) if within else (1.0, 0.0)
    along, across = (c, s) if octant % 4 in (0, 3) else (s, c)
    along = along if octant in (0, 1, 6, 7) else -along
    across = across if octant in (0, 1, 2, 3) else -across
    return along + 0.0, across + 0.0  # never -0.0


def _cos_sin(half_turns: Decimal) -> tuple[float, float]:
    """Return cos and sin of pi * half_turns, 0 to 1/4, from their series to 50 digits."""
    with localcontext() as context:
        context.prec = 55
        x = PI * half_turns
        parts, term = [Decimal(1), x], x
        for k in range(2, 50):
            term = term * x / k
            parts.append(term if k % 4 < 2 else -term)
        return float(sum(parts[0::2])), float(sum(parts[1::2]))
