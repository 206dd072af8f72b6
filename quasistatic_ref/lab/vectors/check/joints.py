"""Which entries of q and delta_q belong to which joint of a case's mechanism.

The checker keeps to plain float64: the mechanism in exact numbers is what the answers are measured
against.
"""

from __future__ import annotations

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
