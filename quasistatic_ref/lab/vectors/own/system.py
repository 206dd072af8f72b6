"""A mechanism of the vectors as the package knows it: URDFs in a System.

What `own` answers must go the way that users' robots go; so each tree becomes the text of a URDF.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import ModelError
from quasistatic_ref.lab.made_steps.systems import (
    joint_text,
    link_text,
    robot_text,
    system_of,
    words,
)
from quasistatic_ref.lab.program.rotation import rotation
from quasistatic_ref.lab.vectors.converters import places
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.text.json_text import plain

_BASES = ("floating", "planar")


@dataclass(frozen=True, eq=False)
class OwnSystem:
    """A System, and where each coordinate and body of the mechanism file stands in it.

    Parameters
    ----------
    system : System
    q, v : ndarray of int
        Which entry of the System's q and delta_q each of the mechanism's is.
    units : tuple of slice
        The quaternions and (cos, sin) in the mechanism's q.
    links : dict of str to int
        Link of each body.
    """

    system: System
    q: NDArray[np.int64]
    v: NDArray[np.int64]
    units: tuple[slice, ...]
    links: dict[str | None, int]

    def model_q(self, q: Sequence[float]) -> Array:
        """Configuration (n_q,) of the System, its quaternions normalised, as pinocchio does not."""
        unit = np.array(q, dtype=np.float64)
        for part in self.units:
            unit[part] /= np.hypot.reduce(unit[part])
        return _scattered(unit, self.q)

    def model_v(self, delta_q: Sequence[float]) -> Array:
        """Vector of delta_q of the System, shape (n_v,)."""
        return _scattered(np.array(delta_q, dtype=np.float64), self.v)


def own_system(mechanism: dict[str, Any]) -> OwnSystem:
    """The System of a mechanism.

    Raises
    ------
    ModelError
        If the mechanism is none that the package can hold: a floating or planar joint between
        two bodies, a floating base with a frame of its own, a planar base that is not upright.
    """
    return _own_system(json.dumps(plain(mechanism)))


@lru_cache(maxsize=8)  # cases of one scene follow each other
def _own_system(text: str) -> OwnSystem:
    """The System of a mechanism that is written as JSON."""
    mechanism = json.loads(text)
    bodies = mechanism["bodies"]
    tree: dict[str, int] = {}
    for k, body in enumerate(bodies):
        tree[body["name"]] = k if body["parent"] is None else tree[body["parent"]]
    texts = {}
    settings = {}
    for root in dict.fromkeys(tree.values()):
        members = [k for k, body in enumerate(bodies) if tree[body["name"]] == root]
        texts[f"t{root}"], settings[f"t{root}"] = _tree(bodies, root, members)
    system = system_of(texts, **settings)
    joints = {joint.name: joint for joint in system.joints}
    numbers = {body["name"]: k for k, body in enumerate(bodies)}
    q: list[int] = []
    v: list[int] = []
    units = []
    for body, slices, _ in places(mechanism):
        if body["joint"] == "fixed":
            continue
        joint = joints[f"t{tree[body['name']]}/{_joint(body, numbers[body['name']])}"]
        if joint.unit_vector:
            units.append(slice(slices.start + joint.lengths, slices.stop))
        q += range(joint.q.start, joint.q.stop)
        v += range(joint.v.start, joint.v.stop)
    links = {name: system.link(f"t{tree[name]}/b{k}") for name, k in numbers.items()}
    links[None] = 0
    return OwnSystem(system, np.array(q, np.int64), np.array(v, np.int64), tuple(units), links)


def _joint(body: dict[str, Any], k: int) -> str:
    return "base" if body["joint"] in _BASES else _joint_name(k)


def _joint_name(k: int) -> str:
    # Pinocchio visits joints by name, and wants one that is followed before those that follow it.
    return f"j{k:04d}"


def _tree(
    bodies: list[dict[str, Any]], root: int, members: list[int]
) -> tuple[str, dict[str, Any]]:
    """URDF and settings of a tree."""
    first = bodies[root]
    base = first["joint"] if first["joint"] in _BASES else "fixed"
    xyz = first["placement"]["xyz"]
    rpy = _rpy(first["placement"]["quaternion"])
    if (base == "floating" and (any(xyz) or any(rpy))) or (
        base == "planar" and (any(xyz[:2]) or any(rpy))
    ):
        problem = "must be the identity, but for the height of a planar base"
        raise ModelError(problem, field=f"{first['name']}.placement", value=first["placement"])
    elements = ['<link name="anchor"/>'] if base == "fixed" else []
    for k in members:
        body = bodies[k]
        elements.append(_link(k, body))
        if k == root and base != "fixed":
            continue
        if body["joint"] in _BASES:
            problem = "must connect a body to the world"
            raise ModelError(problem, field=f"{body['name']}.joint", value=body["joint"])
        names = [other["name"] for other in bodies]
        parent = "anchor" if k == root else f"b{names.index(body['parent'])}"
        elements.append(_urdf_joint(k, body, parent, names))
    actuated = [
        _joint(bodies[k], k)
        for k in members
        if bodies[k].get("actuated") and bodies[k]["joint"] != "fixed" and "mimic" not in bodies[k]
    ]
    place = (0.0, 0.0, xyz[2]) if base == "planar" else (0.0, 0.0, 0.0)
    return robot_text(*elements), {"base": base, "actuated": actuated, "xyz": place}


def _link(k: int, body: dict[str, Any]) -> str:
    inertia = body.get("inertia", np.eye(3))
    return link_text(f"b{k}", body.get("mass", 1.0), inertia, com=body.get("com", (0, 0, 0)))


def _urdf_joint(k: int, body: dict[str, Any], parent: str, names: list[str]) -> str:
    mimic = ""
    place = body["placement"]
    if "mimic" in body:
        follow = body["mimic"]
        mimic = (
            f'<mimic joint="{_joint_name(names.index(follow["of"]))}" '
            f'multiplier="{follow["multiplier"]!r}" offset="{follow["offset"]!r}"/>'
        )
    return joint_text(
        _joint_name(k), body["joint"], parent, f"b{k}", words(body["axis"]),
        words(place["xyz"]), words(_rpy(place["quaternion"])), mimic,
    )  # fmt: skip


def _rpy(quaternion: Sequence[float]) -> list[float]:
    """Roll, pitch, yaw with Rz(yaw) Ry(pitch) Rx(roll) = R, also where the pitch is a quarter turn.

    The yaw is taken after the roll, from what the roll leaves: each may be arbitrary there, but
    not both.
    """
    R = rotation(quaternion)
    roll = np.arctan2(R[2, 1], R[2, 2])
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    c = np.cos(roll)
    s = np.sin(roll)
    yaw = np.arctan2(s * R[0, 2] - c * R[0, 1], c * R[1, 1] - s * R[1, 2])
    return [float(roll) + 0.0, float(pitch) + 0.0, float(yaw) + 0.0]


def _scattered(values: Array, at: NDArray[np.int64]) -> Array:
    out = np.empty(at.size)
    out[at] = values
    return out
