"""A kinematic tree in exact numbers: where its bodies are and how they move with delta_q.

The conventions are those of the package: q = [q_a; q_u], each block in file order; a floating
joint's q is x y z and a quaternion [x y z w], its delta_q a twist in the body's own frame; a
planar joint's q is x, y, cos, sin, its delta_q x, y along the body's own axes and the angle; a
continuous joint's q is cos, sin. Quaternions and (cos, sin) of any length stand for that of
length one.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.lab.vectors.exact.algebra import (
    IDENTITY,
    ZERO,
    Matrix,
    Vector,
    add,
    along,
    cross,
    moved,
    product,
    scaled,
    times,
    transposed,
    unit,
)
from quasistatic_ref.lab.vectors.exact.precision import Real, number, numbers
from quasistatic_ref.lab.vectors.exact.rotation import (
    axis_rotation,
    cos_sin,
    rotation,
)

SIZES: Final = {
    "fixed": (0, 0),
    "revolute": (1, 1),
    "continuous": (2, 1),
    "prismatic": (1, 1),
    "floating": (7, 6),
    "planar": (4, 3),
}
"""Entries of q and of delta_q of each kind of joint."""


@dataclass(frozen=True, eq=False)
class MechanismBody:
    """One body and the joint that carries it; all numbers are rational.

    Parameters
    ----------
    name : str
    parent : int or None
        Number of the body that carries it, smaller than its own; None is the world.
    R, t : matrix and vector
        Frame of the joint in that of the parent at position zero.
    kind : str
        A key of SIZES.
    axis : vector
        Of any length, in the joint's frame.
    actuated : bool
    q, v : slice
        The joint's entries of q and delta_q, in the paper's order.
    mimic : (number, number) or None
        Multiplier and offset of a joint without entries of its own: q and v are those of the
        joint that it follows.
    table : dict
        The body as written, with ``mass``, ``com`` and ``inertia`` where a layer needs them.
    """

    name: str
    parent: int | None
    R: Matrix
    t: Vector
    kind: str
    axis: Vector
    actuated: bool
    q: slice
    v: slice
    mimic: tuple[Real, Real] | None
    table: dict[str, Any]


@dataclass(frozen=True, eq=False)
class Mechanism:
    """Bodies, parents before children, and the sizes of q = [q_a; q_u] and delta_q."""

    bodies: tuple[MechanismBody, ...]
    n_q: int
    n_v: int
    n_a: int

    def number(self, name: str | None) -> int | None:
        """Number of a body; None for the world; InputError if unknown."""
        if name is None:
            return None
        names = [body.name for body in self.bodies]
        if name not in names:
            raise InputError(f"is no body{suggestion(name, names)}", field="body", value=name)
        return names.index(name)


@dataclass(frozen=True, eq=False)
class Poses:
    """Where every body is and how it moves.

    Parameters
    ----------
    R, t : list of matrix, list of vector
        Frame of each body in the world [-, m].
    columns : list of dict
        For each body, from an entry of delta_q that moves it to the velocity of its origin and
        its angular velocity, both in the world frame.
    """

    R: list[Matrix]
    t: list[Vector]
    columns: list[dict[int, tuple[Vector, Vector]]]

    def point_columns(self, body: int | None, point: Vector) -> dict[int, tuple[Vector, Vector]]:
        """The same, of the body's material point that is at a point of the world."""
        if body is None:
            return {}
        r = add(point, scaled(self.t[body], -1))
        return {v: (add(nu, cross(w, r)), w) for v, (nu, w) in self.columns[body].items()}


def mechanism(table: dict[str, Any]) -> Mechanism:
    """A mechanism as written in a case.

    Raises
    ------
    InputError
        If a kind of joint is unknown, or a parent does not come before its child.
    """
    written = table["bodies"]
    names = [body["name"] for body in written]
    places: dict[int, tuple[slice, slice]] = {}
    n_q = n_v = n_a = 0
    for actuated in (True, False):
        for k, body in enumerate(written):
            if body["joint"] not in SIZES:
                problem = f"is not a kind of joint{suggestion(str(body['joint']), SIZES)}"
                raise InputError(problem, field=f"bodies[{k}].joint", value=body["joint"])
            if (bool(body.get("actuated")) and body["joint"] != "fixed") != actuated:
                continue
            if "mimic" in body:
                continue
            size_q, size_v = SIZES[body["joint"]]
            places[k] = slice(n_q, n_q + size_q), slice(n_v, n_v + size_v)
            n_q, n_v = n_q + size_q, n_v + size_v
        n_a = n_v if actuated else n_a
    bodies = []
    for k, body in enumerate(written):
        if "mimic" in body:
            places[k] = places[_followed(written, k, places)]
        if body["parent"] is not None and body["parent"] not in names[:k]:
            problem = f"must be a body before it{suggestion(str(body['parent']), names[:k])}"
            raise InputError(problem, field=f"bodies[{k}].parent", value=body["parent"])
        bodies.append(
            MechanismBody(
                name=body["name"],
                parent=None if body["parent"] is None else names.index(body["parent"]),
                R=rotation(numbers(body["placement"]["quaternion"])),
                t=numbers(body["placement"]["xyz"]),
                kind=body["joint"],
                axis=numbers(body.get("axis", [0, 0, 1])),
                actuated=bool(body.get("actuated")),
                q=places[k][0],
                v=places[k][1],
                mimic=_mimic(body),
                table=body,
            )
        )
    return Mechanism(tuple(bodies), n_q, n_v, n_a)


def _followed(written: Sequence[dict[str, Any]], k: int, places: dict[int, Any]) -> int:
    """Number of the body whose joint a mimic joint follows: one with a coordinate of its own."""
    of = written[k]["mimic"]["of"]
    scalar = {
        other["name"]: i
        for i, other in enumerate(written)
        if i in places and other["joint"] in ("revolute", "prismatic") and "mimic" not in other
    }
    if of not in scalar or written[k]["joint"] not in ("revolute", "prismatic"):
        problem = f"must follow a revolute or prismatic joint, being one{suggestion(of, scalar)}"
        raise InputError(problem, field=f"bodies[{k}].mimic", value=of)
    return scalar[of]


def _mimic(body: dict[str, Any]) -> tuple[Real, Real] | None:
    if "mimic" not in body:
        return None
    return number(body["mimic"]["multiplier"]), number(body["mimic"]["offset"])


def poses(mechanism: Mechanism, q: Sequence[float]) -> Poses:
    """Pose and Jacobian of every body at q.

    Raises
    ------
    InputError
        If q has another length.
    """
    check_length("q", q, mechanism.n_q)
    Rs: list[Matrix] = []
    ts: list[Vector] = []
    columns: list[dict[int, tuple[Vector, Vector]]] = []
    for body in mechanism.bodies:
        R, t, inherited = IDENTITY, ZERO, {}
        if body.parent is not None:
            R, t, inherited = Rs[body.parent], ts[body.parent], columns[body.parent]
        R, t_joint = product(R, body.R), moved(R, t, body.t)
        position, pace = numbers(q[body.q]), fmpq(1)
        if body.mimic is not None:
            pace, offset = body.mimic
            position = [pace * position[0] + offset]
        R_joint, inside = _joint_pose(body, position)
        world, origin = product(R, R_joint), moved(R, t_joint, inside)
        r = add(origin, scaled(t, -1))
        moves = {v: (add(nu, cross(w, r)), w) for v, (nu, w) in inherited.items()}
        axes = transposed(world)
        for k, (nu, w) in enumerate(_joint_columns(body, axes)):
            before = moves.get(body.v.start + k, (ZERO, ZERO))
            moves[body.v.start + k] = along(before[0], nu, pace), along(before[1], w, pace)
        Rs.append(world)
        ts.append(origin)
        columns.append(moves)
    return Poses(Rs, ts, columns)


def _joint_pose(body: MechanismBody, q: Vector) -> tuple[Matrix, Vector]:
    """Frame of the body in that of its joint."""
    match body.kind:
        case "revolute":
            return axis_rotation(unit(body.axis), *cos_sin(q[0])), ZERO
        case "continuous":
            return axis_rotation(unit(body.axis), *unit(q)), ZERO
        case "prismatic":
            return IDENTITY, scaled(unit(body.axis), q[0])
        case "floating":
            return rotation(q[3:]), q[:3]
        case "planar":
            return axis_rotation(IDENTITY[2], *unit(q[2:])), [*q[:2], fmpq(0)]
        case _:
            return IDENTITY, ZERO


def _joint_columns(body: MechanismBody, axes: Matrix) -> list[tuple[Vector, Vector]]:
    """Velocity of the body's origin and angular velocity for each entry of its own delta_q."""
    turning = [(ZERO, e) for e in axes]
    sliding = [(e, ZERO) for e in axes]
    match body.kind:
        case "revolute" | "continuous":  # a rotation about its axis keeps it where it is
            return [(ZERO, times(transposed(axes), unit(body.axis)))]
        case "prismatic":
            return [(times(transposed(axes), unit(body.axis)), ZERO)]
        case "floating":
            return sliding + turning
        case "planar":
            return [*sliding[:2], turning[2]]
        case _:
            return []


def check_length(field: str, values: Sequence[float], length: int) -> None:
    """InputError if the values, of shape (k,) [m, rad], are a q or delta_q of another mechanism."""
    if len(values) != length:
        raise InputError(f"must hold {length} numbers", field=field, value=len(values))
