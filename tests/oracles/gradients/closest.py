"""Closest points of two solids without rounding, from where float64 has them: Newton's method.

On the parts of both surfaces that float64 shows, the line between the points is at right angles to
both: as many equations as coordinates. Apart, convex solids have no other such pair; in
penetration it is the way out that float64 took. The derivatives of the equations are quotients
over 2^-160, so that each step doubles the digits until there are more than the grid has.
"""

from typing import Final

import numpy as np
from flint import arb, arb_mat, fmpq

from quasistatic_ref.lab.vectors.distances.shapes import Placed
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.algebra import Vector, dot, scaled, squared, subtract
from quasistatic_ref.lab.vectors.exact.precision import rational_near
from quasistatic_ref.lab.vectors.whole.grid import SMALL, working
from tests.oracles.gradients.patches import Patch, patch

QUOTIENT: Final = fmpq(1, 1 << 160)
STEPS: Final = 12
"""Of Newton's method at most; five double 1e-9 to 1e-100 and beyond."""
DONE: Final = fmpq(1, 1 << 340)
"""A step that is smaller [m, rad] is the last."""
SAME: Final = 1e-6
"""How far the result may be from where float64 has it [m, -]."""


def closest_pair(alpha: Placed, beta: Placed, start: Witness) -> Witness:
    """Closest points, distance and normal.

    Parameters
    ----------
    alpha, beta : Placed
        Neither a sphere nor a half-space nor a cloud.
    start : Witness
        Nearly the same, in rational numbers.

    Raises
    ------
    ArithmeticError
        If Newton's method does not settle, or settles elsewhere.
    """
    with working():
        parts = [
            patch(solid, solid.local(end), solid.local_direction(scaled(start.n, sign)))
            for solid, end, sign in ((alpha, start.alpha, 1), (beta, start.beta, -1))
        ]
        u: Vector = [arb(0)] * (parts[0].size + parts[1].size)
        for _ in range(STEPS):
            step = _step(parts, u)
            u = [(x - y).mid() for x, y in zip(u, step, strict=True)]
            if all(abs(x) < DONE for x in step):
                return _witness(parts, u, start)
    raise ArithmeticError("Newton's method does not settle")


def _ends(parts: list[Patch], u: Vector) -> list[tuple[Vector, list[Vector]]]:
    first = parts[0].size
    return [parts[0].at(u[:first]), parts[1].at(u[first:])]


def _equations(parts: list[Patch], u: Vector) -> Vector:
    (a, of_a), (b, of_b) = _ends(parts, u)
    between = subtract(b, a)
    return [dot(between, way) for way in (*of_a, *of_b)]


def _step(parts: list[Patch], u: Vector) -> Vector:
    now = [x.mid() for x in map(arb, _equations(parts, u))]
    n = len(u)
    if not n:
        return []
    columns = []
    for j in range(n):
        moved = [x + QUOTIENT * int(i == j) for i, x in enumerate(u)]
        ahead = _equations(parts, moved)
        columns.append([(arb(x).mid() - y) / QUOTIENT for x, y in zip(ahead, now, strict=True)])
    matrix = arb_mat(n, n, [columns[j][i].mid() for i in range(n) for j in range(n)])
    found = matrix.solve(arb_mat(n, 1, now))
    return [found[i, 0].mid() for i in range(n)]


def _witness(parts: list[Patch], u: Vector, start: Witness) -> Witness:
    (a, _), (b, _) = _ends(parts, u)
    a, b = ([rational_near(arb(x)) for x in end] for end in (a, b))
    margins = parts[0].margin, parts[1].margin
    between = subtract(b, a)
    length = arb(squared(between)).sqrt()
    if length < SMALL:
        raise ArithmeticError("no normal at zero distance")
    if dot(between, start.n) < 0:
        length = -length
    n = [x / length for x in between]
    found = Witness(length, a, b, n, True).inflated(*margins)
    apart = [
        float(x - y)
        for mine, theirs in ((found.alpha, start.alpha), (found.beta, start.beta), (n, start.n))
        for x, y in zip(mine, theirs, strict=True)
    ]
    if np.abs(apart).max() > SAME:
        raise ArithmeticError(f"Newton's method settles {np.abs(apart).max():.1e} away")
    return found
