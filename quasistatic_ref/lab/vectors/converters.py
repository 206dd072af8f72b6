"""Other conventions in circulation, and the way back to those of the package.

:data:`CONVENTIONS` is the table of ways to write the quadratic program of a step. Tangent spaces
and quaternion orders are what an answer may declare; :func:`converted` undoes them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.lab.vectors.check.joints import base_rotations, places, quaternion_places
from quasistatic_ref.lab.vectors.expected import Json

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Program:
    """min 1/2 x'Hx - g'x subject to A x >= b, and its solution.

    Parameters
    ----------
    H, g, A, b : ndarray, shapes (n, n), (n,), (m, n), (m,)
    x : ndarray, shape (n,)
    lam : ndarray, shape (m,)
        H x - g = A' lam.
    """

    H: Array
    g: Array
    A: Array
    b: Array
    x: Array
    lam: Array


@dataclass(frozen=True)
class Convention:
    """One way to write a step.

    Parameters
    ----------
    unknown, multipliers : str
        What x and lam then are.
    note : str
        What becomes of H, g, A, b.
    written : callable
        (program in the package's convention, h, x_k) -> the same program in this one.
    read : callable
        The way back.
    """

    unknown: str
    multipliers: str
    note: str
    written: Callable[[Program, float, Array], Program]
    read: Callable[[Program, float, Array], Program]


def velocities(p: Program, h: float, x: Array) -> Program:
    """X = v = delta_q / h: H holds h^2 K_q and M_u."""
    return Program(h * p.H, p.g, p.A, p.b / h, p.x / h, p.lam)


def from_velocities(p: Program, h: float, x: Array) -> Program:
    """Inverse of :func:`velocities`."""
    return Program(p.H / h, p.g, p.A, p.b * h, p.x * h, p.lam)


def next_positions(p: Program, h: float, x: Array) -> Program:
    """X = x_k + delta_q, for coordinates that add: not for turns of a floating base."""
    return Program(p.H, p.g + p.H @ x, p.A, p.b + p.A @ x, p.x + x, p.lam)


def from_next_positions(p: Program, h: float, x: Array) -> Program:
    """Inverse of :func:`next_positions`."""
    return Program(p.H, p.g - p.H @ x, p.A, p.b - p.A @ x, p.x - x, p.lam)


def forces(p: Program, h: float, x: Array) -> Program:
    """Lam / h, forces in the place of impulses: H holds K_q and M_u / h^2."""
    return Program(p.H / h, p.g / h, p.A, p.b, p.x, p.lam / h)


def from_forces(p: Program, h: float, x: Array) -> Program:
    """Inverse of :func:`forces`."""
    return Program(p.H * h, p.g * h, p.A, p.b, p.x, p.lam * h)


CONVENTIONS: Final = {
    "velocities": Convention(
        unknown="v = delta_q / h [m/s, rad/s]",
        multipliers="impulses [N s]",
        note="H = blockdiag(h^2 K_q, M_u), g as ours, A as ours, b / h",
        written=velocities,
        read=from_velocities,
    ),
    "next positions": Convention(
        unknown="x_next = x_k + delta_q [m, rad]",
        multipliers="impulses [N s]",
        note="H as ours, g + H x_k, A as ours, b + A x_k",
        written=next_positions,
        read=from_next_positions,
    ),
    "forces": Convention(
        unknown="delta_q [m, rad]",
        multipliers="forces [N], lam / h",
        note="H = blockdiag(K_q, M_u / h^2), g / h, A and b as ours",
        written=forces,
        read=from_forces,
    ),
}
"""By name. Everything else is ours: H = blockdiag(h K_q, M_u / h), lam an impulse."""


def tangent_map(mechanism: Json, q: Json, tangent: str) -> Array:
    """B with delta_q = B (delta_q in another tangent space), shape (n_v, n_v); orthogonal.

    Parameters
    ----------
    mechanism, q
        Of a case.
    tangent : str
        ``"body"``; ``"world"``: a floating base's linear and angular part along the world's axes;
        ``"mujoco"``: only its linear part.
    """
    n_v = sum(at.v.stop - at.v.start for at in places(mechanism))
    B = np.eye(n_v)
    for at, R in base_rotations(mechanism, q) if tangent != "body" else []:
        for part in (0, 3) if tangent == "world" else (0,):
            block = slice(at.start + part, at.start + part + 3)
            B[block, block] = R.T
    return B


def converted(layer: str, case: Json, output: Json, tangent: str, quaternion: str) -> Json:
    """An answer in the package's conventions; one that has them already is returned as it is.

    Raises
    ------
    ValueError
        If it is of a shape that cannot be converted.
    """
    if not isinstance(output, dict) or "farkas" in output:
        return output
    field = {"integrate": "q", "step": "q_next"}.get(layer)
    if quaternion == "wxyz" and field in output:
        output = {**output, field: xyzw(case["mechanism"], output[field])}
    if tangent != "body" and layer in ("jacobian", "step"):
        B = tangent_map(case["mechanism"], case["q"], tangent)
        output = _turned(output, B)
    return output


def xyzw(mechanism: Json, q: Json) -> Json:
    """A configuration whose quaternions are [w, x, y, z], with [x, y, z, w]."""
    return _rolled(mechanism, q, -1)


def wxyz(mechanism: Json, q: Json) -> Json:
    """A configuration whose quaternions are [x, y, z, w], with [w, x, y, z]."""
    return _rolled(mechanism, q, 1)


def _rolled(mechanism: Json, q: Json, by: int) -> Json:
    if not isinstance(q, list):
        raise TypeError("q must be a list")
    q = list(q)
    for at in quaternion_places(mechanism):
        q[at] = q[at][-by:] + q[at][:-by]
    return q


def _turned(output: Json, B: Array) -> Json:
    """Every field that has to do with delta_q, from another tangent space: x = B y."""
    rules: dict[str, Callable[[Array], Array]] = {
        "J": lambda J: J @ B.T,
        "A": lambda A: A @ B.T,
        "H": lambda H: B @ H @ B.T,
        "g": lambda g: B @ g,
        "delta_q": lambda x: B @ x,
        "A_lam": lambda p: B @ p,
    }
    turned = {}
    for name, value in output.items():
        if name == "contacts":
            turned[name] = [_turned(contact, B) for contact in value]
        elif name in rules and np.size(value):
            turned[name] = rules[name](_floats(value)).tolist()
        else:
            turned[name] = value
    return turned


def _floats(value: Any) -> Array:
    return np.array(value, dtype=np.float64)
