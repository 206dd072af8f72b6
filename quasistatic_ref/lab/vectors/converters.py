"""Tangent spaces and quaternion orders that an answer may declare, and the way back to ours.

Which entries of q and delta_q belong to which joint of a case's mechanism, in plain float64: the
mechanism in exact numbers is what the answers are measured against.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.lab.vectors.check.valid_witness import rotation
from quasistatic_ref.lab.vectors.exact.mechanism import SIZES
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.step.data import Array


@dataclass(frozen=True)
class Places:
    """A body's joint, and its entries of q and delta_q."""

    name: str
    kind: str
    q: slice
    v: slice


def places(mechanism: Json) -> list[Places]:
    """Of every body, in the paper's order: actuated ones first, each part in file order.

    A mimic joint has no entries, and no place.
    """
    found, i, k = [], 0, 0
    for actuated in (True, False):
        for body in mechanism["bodies"]:
            if bool(body.get("actuated")) == actuated and "mimic" not in body:
                kind = body["joint"]
                size_q, size_v = SIZES[kind]
                found.append(Places(body["name"], kind, slice(i, i + size_q), slice(k, k + size_v)))
                i, k = i + size_q, k + size_v
    return found


def quaternion_places(mechanism: Json) -> list[slice]:
    """The entries of q that are quaternions."""
    return [slice(at.q.start + 3, at.q.stop) for at in places(mechanism) if at.kind == "floating"]


def base_rotations(mechanism: Json, q: Json) -> list[tuple[slice, Array]]:
    """Of each floating joint its entries of delta_q, and R (3, 3), from body to world at q."""
    at = {place.name: place for place in places(mechanism)}
    R: dict[str | None, Array] = {None: np.eye(3)}
    found = []
    for body in mechanism["bodies"]:
        mimic = body.get("mimic", {"of": body["name"], "multiplier": 1.0, "offset": 0.0})
        place = at[mimic["of"]]
        position = mimic["multiplier"] * np.array(q[place.q], dtype=np.float64) + mimic["offset"]
        turned = R[body["parent"]] @ rotation(body["placement"]["quaternion"])
        R[body["name"]] = turned @ _joint_rotation(body, position)
        if place.kind == "floating":
            found.append((place.v, R[body["name"]]))
    return found


def _joint_rotation(body: Json, q: Array) -> Array:
    """Rotation that a joint makes at its entries of q."""
    match body["joint"]:
        case "floating":
            return rotation(q[3:])
        case "planar":
            return _turn(np.array([0.0, 0.0, 1.0]), np.arctan2(q[3], q[2]))
        case "continuous":
            return _turn(np.array(body["axis"]), np.arctan2(q[1], q[0]))
        case "revolute":
            return _turn(np.array(body["axis"]), q[0])
        case _:
            return np.eye(3)


def _turn(axis: Array, angle: float) -> Array:
    half = np.sin(angle / 2) * axis / np.linalg.norm(axis)
    return rotation([*half, np.cos(angle / 2)])


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
            turned[name] = rules[name](np.array(value, dtype=np.float64)).tolist()
        else:
            turned[name] = value
    return turned
