"""Tangent spaces and quaternion orders that an answer may declare, and the way back to ours."""

from collections.abc import Callable, Iterator

import numpy as np

from quasistatic_ref.lab.program.mechanism import kinematics, slices
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.numbers.arrays import Array


def places(mechanism: Json) -> Iterator[tuple[Json, slice, slice]]:
    """Each body with coordinates of its own, and its entries of q and delta_q."""
    bodies = {body["name"]: body for body in mechanism["bodies"]}
    for name, (q, v) in slices(mechanism)[0].items():
        yield bodies[name], q, v


def quaternion_places(mechanism: Json) -> list[slice]:
    """The entries of q that are quaternions."""
    floating = (q for body, q, _ in places(mechanism) if body["joint"] == "floating")
    return [slice(q.start + 3, q.stop) for q in floating]


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
    B = np.eye(slices(mechanism)[2])
    if tangent == "body":
        return B
    at = kinematics(mechanism, np.array(q, dtype=np.float64))
    for body, _, v in places(mechanism):
        if body["joint"] == "floating":
            for part in (0, 3) if tangent == "world" else (0,):
                block = slice(v.start + part, v.start + part + 3)
                B[block, block] = at[body["name"]][0].T
    return B


def converted(layer: str, case: Json, output: Json, tangent: str, quaternion: str) -> Json:
    """An answer in the package's conventions, converted from those of another program.

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
    """A configuration whose quaternions are [w, x, y, z], with [x, y, z, w].

    Raises
    ------
    TypeError
        If q is not a list.
    """
    if not isinstance(q, list):
        raise TypeError("q must be a list")
    q = list(q)
    for at in quaternion_places(mechanism):
        q[at] = q[at][1:] + q[at][:1]
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
            turned[name] = rules[name](np.array(value, dtype=np.float64)).tolist()
        else:
            turned[name] = value
    return turned
