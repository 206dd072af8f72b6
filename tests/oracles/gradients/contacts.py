"""Candidates of every pair of shapes without rounding: where the layers of the vectors have none.

Two solids have corners beside their closest pair: vertices, ends of a capsule with a ball about
them, quarter points of rims. Where closest pairs have a closed form it is taken; elsewhere
`closest` follows float64's.
"""

from collections.abc import Sequence
from itertools import product
from typing import Final

from flint import arb, fmpq

from quasistatic_ref.contact.distance import in_world as own_placed
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.distances.shapes import Placed
from quasistatic_ref.lab.vectors.distances.solid_pair import pair_witness, point_witness
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.algebra import IDENTITY, Vector, scaled, squared
from quasistatic_ref.lab.vectors.exact.precision import numbers
from quasistatic_ref.lab.vectors.whole.grid import on_grid, vector_on_grid, working
from quasistatic_ref.lab.vectors.whole.nearby import Near, candidates
from quasistatic_ref.lab.vectors.whole.world import World
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.tolerances import UPRIGHT
from tests.oracles.gradients.closest import closest_pair

CURVED: Final = {"cylinder", "cone", "ellipsoid"}
CLOSED: Final = {"sphere", "halfspace", "cloud"}
"""A pair with one of these has a closed form, apart and in penetration."""


def starts(simulator: Simulator, kinematics: Kinematics) -> list[Witness | None]:
    """Where float64 has the closest pair of each pair of solids; None where it is not asked."""
    found: list[Witness | None] = []
    for pair in simulator.pairs:
        if pair.has_cloud:
            found.append(None)
            continue
        a, b = (own_placed(side, kinematics.R, kinematics.t) for side in (pair.alpha, pair.beta))
        one = solid_pair(pair.name, a, b)
        ends = (numbers(x.tolist()) for x in (one.alpha, one.beta, one.n))
        found.append(Witness(fmpq(*one.phi.as_integer_ratio()), *ends, True))
    return found


def nearby(
    at: World, pair: int, start: Witness | None, wanted: Sequence[int] | None = None
) -> list[Near]:
    """Candidates of a pair in their order; of those wanted only, if they are named.

    Parameters
    ----------
    at : World
    pair : int
    start : Witness or None
        As of `starts`.
    wanted : sequence of int, optional
    """
    written = at.case["pairs"][pair]
    names = [written["alpha"], written["beta"]]
    kinds = [at.case["shapes"][name]["shape"]["kind"] for name in names]
    if start is None or (written["k"] == 1 and set(kinds) & CLOSED):
        return candidates(at, pair, wanted)
    alpha, beta = (at.shape(name) for name in names)
    with working():
        nearest = _on_grid(_nearest(alpha, beta, start))
        if written["k"] == 1:
            return [_near(pair, 0, nearest)]
        found = []
        first = _corners(alpha, alpha.local_direction(nearest.n))
        last = _corners(beta, beta.local_direction(scaled(nearest.n, -1)))
        for index, (point, radius) in enumerate(first):
            if wanted is None or index in wanted:
                one = point_witness(beta, vector_on_grid(alpha.world(point))).swapped()
                found.append(_near(pair, index, one.inflated(radius, fmpq(0))))
        for index, (point, radius) in enumerate(last, len(first)):
            if wanted is None or index in wanted:
                one = point_witness(alpha, vector_on_grid(beta.world(point)))
                found.append(_near(pair, index, one.inflated(fmpq(0), radius)))
        index = len(first) + len(last)
        if wanted is None or index in wanted:
            found.append(_near(pair, index, nearest))
        return found


def _nearest(alpha: Placed, beta: Placed, start: Witness) -> Witness:
    """The closest pair by its closed form, or else where float64 has it."""
    curved = {alpha.kind, beta.kind} & CURVED and not {alpha.kind, beta.kind} & CLOSED
    if not (curved and start.phi <= 0):
        try:
            return pair_witness(alpha, beta)
        except InputError:  # there is none
            pass
    return closest_pair(alpha, beta, start)


def _corners(solid: Placed, towards: Vector) -> list[tuple[Vector, fmpq]]:
    """Corners in the solid's own frame, in the package's order, and the ball about each."""
    zero = fmpq(0)
    match solid.kind:
        case "box":
            signs = [(x, y, z) for z, y, x in product((-1, 1), repeat=3)]
            return [
                ([s * h for s, h in zip(sign, solid.sizes, strict=True)], zero) for sign in signs
            ]
        case "convex":
            return [(point, zero) for point in solid.points]
        case "capsule":
            radius, half = solid.sizes
            return [([zero, zero, -half], radius), ([zero, zero, half], radius)]
        case "cylinder":
            radius, half = solid.sizes
            rims = [*_rim(radius, -half, towards), *_rim(radius, half, towards)]
            return [(point, zero) for point in rims]
        case "cone":
            radius, half = solid.sizes
            return [(point, zero) for point in ([zero, zero, half], *_rim(radius, -half, towards))]
        case _:
            return []


def _rim(radius: fmpq, height: fmpq, towards: Vector) -> list[Vector]:
    """Four points of a rim, the first nearest to the other body; on the x axis if it is level."""
    length = arb(squared(towards[:2])).sqrt()
    if length < UPRIGHT:
        towards, length = IDENTITY[0], arb(1)
    x, y = (radius * value / length for value in towards[:2])
    return [[x, y, height], [-y, x, height], [-x, -y, height], [y, -x, height]]


def _on_grid(one: Witness) -> Witness:
    ends = (vector_on_grid(x) for x in (one.alpha, one.beta, one.n))
    return Witness(on_grid(one.phi), *ends, True)


def _near(pair: int, index: int, one: Witness) -> Near:
    ends = (vector_on_grid(x) for x in (one.alpha, one.beta, one.n))
    return Near(pair, index, on_grid(one.phi), *ends)
