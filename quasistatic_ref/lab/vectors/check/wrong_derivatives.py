"""What mistakes about derivatives answer: columns of other maps, and numbers where there are none.

A mistake about contacts is made in every step of a difference: the contact is taken for another one
that agrees with it at the configuration itself.
"""

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np
from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.check.mistake import Mistake, Prediction
from quasistatic_ref.lab.vectors.converters import tangent_map
from quasistatic_ref.lab.vectors.distances.solid_pair import point_witness
from quasistatic_ref.lab.vectors.exact.algebra import Vector
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.unrounded.derivatives import moves
from quasistatic_ref.lab.vectors.unrounded.differences import Base, away, base, quotient
from quasistatic_ref.lab.vectors.unrounded.grid import STEP, on_grid, working
from quasistatic_ref.lab.vectors.unrounded.moved_inputs import with_held_wrenches
from quasistatic_ref.lab.vectors.unrounded.nearby import Near
from quasistatic_ref.lab.vectors.unrounded.step import Change, after
from quasistatic_ref.lab.vectors.unrounded.world import World, world

SIDES: Final = ("alpha", "beta")


def _by_q(one: Base, column: Callable[[Callable[[fmpq], Json]], Vector]) -> Json:
    """A matrix of which each column is that of one coordinate of q."""
    case = one.at.case
    columns = [column(partial(move, case)) for move in moves(one)["q"]]
    return [[float(x) for x in row] for row in zip(*columns, strict=True)]


def _of(case: Json, change: Change) -> Json:
    """The derivative dq+/dq if every contact is taken for another one."""
    one = base(with_held_wrenches(case), change)
    return _by_q(one, lambda inputs: quotient(one, inputs, moved=True).column)


def normal_frozen(case: Json, output: Json) -> Iterable[Json]:
    """Every normal stays what it is in the world."""
    right = _kept(base(with_held_wrenches(case)))
    yield {"dq_dq": _of(case, lambda at, near: replace(near, n=right[_name(near)].n))}


def material_points(case: Json, output: Json) -> Iterable[Json]:
    """Closest points that are fixed to their bodies."""
    one = base(with_held_wrenches(case))
    right = _kept(one)

    def change(at: World, near: Near) -> Near:
        own = right[_name(near)]
        points = {side: _carried(one.at, at, near, side, getattr(own, side)) for side in SIDES}
        return replace(near, alpha=points["alpha"], beta=points["beta"])

    yield {"dq_dq": _of(case, change)}


def one_curvature(case: Json, output: Json) -> Iterable[Json]:
    """One of the two surfaces is taken for its tangent plane, or for a point.

    The tangent plane of a body that does not move is a frozen normal, and has its own name.
    """
    one = base(with_held_wrenches(case))
    right = _kept(one)
    for side in SIDES:
        fixed = all(_body(one.at, near, side) is None for near in right.values())
        for flat in (False,) if fixed else (True, False):
            yield {"dq_dq": _of(case, _without_curvature(one, right, side, flat=flat))}


def _without_curvature(
    one: Base, right: dict[tuple[int, int], Near], side: str, *, flat: bool
) -> Change:
    """Contacts whose normal is that of a pair with one surface replaced at its closest point."""
    other = "beta" if side == "alpha" else "alpha"

    def change(at: World, near: Near) -> Near:
        own = right[_name(near)]
        if flat:  # the normal is that of the plane, which its body carries
            return replace(near, n=_turned(one.at, at, near, side, own.n))
        point = _carried(one.at, at, near, side, getattr(own, side))
        return replace(near, n=_normal_towards(at, near, other, point))

    return change


def _normal_towards(at: World, near: Near, other: str, point: Vector) -> Vector:
    """Normal, from alpha to beta, of the surface of the `other` shape below a point."""
    solid = at.shape(at.case["pairs"][near.pair][other])
    if solid.kind == "cloud":
        raise InputError("a point has no surface", field="shape")
    with working():
        found = point_witness(solid, point)
        return on_grid(found.n if other == "alpha" else -found.n)


def plain_sum(case: Json, output: Json) -> Iterable[Json]:
    """Identity plus the derivative of delta_q; or (+) differentiated by q alone."""
    one = base(with_held_wrenches(case))
    step = one.step.delta_q

    def of_step(inputs: Callable[[fmpq], Json]) -> Vector:
        found = quotient(one, inputs, moved=True)
        return (found.sides[0][0].delta_q - found.sides[1][0].delta_q) / (2 * STEP)

    def carried(inputs: Callable[[fmpq], Json]) -> Vector:
        ends = [world(inputs(by)) for by in (STEP, -STEP)]
        up, down = (away(at, one.q_next, after(at, step)) for at in ends)
        return (up - down) / (2 * STEP)

    rate = np.array(_by_q(one, of_step))
    yield {"dq_dq": (np.eye(len(rate)) + rate).tolist()}
    yield {"dq_dq": (np.array(_by_q(one, carried)) + rate).tolist()}


def world_frame(case: Json, output: Json) -> Iterable[Json]:
    """Rows, columns or both along the world's axes."""
    q_next = [float(x) for x in base(with_held_wrenches(case)).q_next]
    D = np.array(output["dq_dq"])
    for tangent in ("world", "mujoco"):
        inside, outside = (tangent_map(case["mechanism"], q, tangent) for q in (case["q"], q_next))
        yield {"dq_dq": (outside.T @ D @ inside).tolist()}
        yield {"dq_dq": (outside.T @ D).tolist()}
        yield {"dq_dq": (D @ inside).tolist()}


def number_at(*kinds: str) -> Prediction:
    """Any numbers where there is no derivative for a reason of one of these kinds."""

    def prediction(case: Json, output: Json) -> Iterable[Json]:
        if {reason["kind"] for reason in output["reasons"]} & set(kinds):
            yield {"differentiable": True}

    return prediction


def _kept(one: Base) -> dict[tuple[int, int], Near]:
    return {_name(contact.near): contact.near for contact in one.contacts}


def _name(near: Near) -> tuple[int, int]:
    return near.pair, near.index


def _body(at: World, near: Near, side: str) -> str | None:
    name: str | None = at.case["shapes"][at.case["pairs"][near.pair][side]]["body"]
    return name


def _carried(before: World, at: World, near: Near, side: str, point: Vector) -> Vector:
    """Where a material point of a body has come to."""
    body = _body(at, near, side)
    if body is None:
        return point
    return _turned(before, at, near, side, point - before.at[body][1]) + at.at[body][1]


def _turned(before: World, at: World, near: Near, side: str, way: Vector) -> Vector:
    """A direction that a body carries with it."""
    body = _body(at, near, side)
    if body is None:
        return way
    return at.at[body][0] @ before.at[body][0].T @ way


DERIVATIVES: Final = (
    Mistake(
        "normal frozen",
        "n, d1 and d2 change with q: closest points move over both surfaces",
        {"derivative": normal_frozen},
    ),
    Mistake(
        "curvature of one body only",
        "the change of n comes from the curvatures of both surfaces at the closest points",
        {"derivative": one_curvature},
    ),
    Mistake(
        "contact point taken as material",
        "J is taken at the closest points, which are other points of the bodies where q is another",
        {"derivative": material_points},
    ),
    Mistake(
        "derivative in the world instead of the body frame",
        "columns are in the tangent space at q, rows in that at q+: a floating base's own axes",
        {"derivative": world_frame},
    ),
    Mistake(
        "(+) not differentiated",
        "q+ is q (+) delta_q, which depends on q besides by delta_q, and by delta_q not as a sum",
        {"derivative": plain_sum},
    ),
    Mistake(
        "sub-gradient at a tie",
        "where q+ has a kink there is no derivative: say so, and why",
        {"derivative": number_at("row", "selection", "feature", "tangents", "touching")},
    ),
    Mistake(
        "sensitivity of a multiplier that is not unique",
        "where rows are dependent and a change makes them contradict, which of them press changes: "
        "there is no derivative",
        {"derivative": number_at("multipliers")},
    ),
)
