"""The paper's order of coordinates, q = [q_a; q_u], and its permutation to pinocchio's order.

Within each block the order is pinocchio's. Outside of `model` all vectors are in the paper's order.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.numbers.arrays import Array, Indices


@dataclass(frozen=True)
class MimicJoint:
    """A joint without coordinates: multiplier [-] * the position of `of` + offset [m, rad]."""

    name: str
    of: str
    multiplier: float
    offset: float


def no_coordinate(of: str) -> str:
    """The sentence that a joint which mimics another has no coordinate."""
    return (
        f"mimics {of!r} and has no coordinate of its own: name {of!r}, whose spring moves both "
        "and whose force K_q e they share"
    )


@dataclass(frozen=True, eq=False)
class Order:
    """The permutation between the paper's order of coordinates and pinocchio's.

    Parameters
    ----------
    joints : tuple of Joint
        In the paper's order.
    q : ndarray of int, shape (n_q,)
        For each entry of the paper's q, its index in pinocchio's q.
    v : ndarray of int, shape (n_v,)
        The same for delta_q.
    """

    joints: tuple[Joint, ...]
    q: Indices
    v: Indices

    def paper_q(self, q: Array) -> Array:
        """Configuration in the paper's order, from pinocchio's; both of shape (n_q,)."""
        return q.take(self.q)

    def paper_v(self, v: Array) -> Array:
        """Delta_q, or J, shape (..., n_v), its last axis in the paper's order, from pinocchio's."""
        return v.take(self.v, axis=-1)


def joint_key(joint: str) -> str:
    """Name of a joint inside the model.

    URDF lets a link and a joint share a name; pinocchio's appendModel does not. No body's name
    holds a space, so that no link has this name.
    """
    return f"joint {joint}"


def paper_order(joints: Sequence[Joint]) -> Order:
    """Actuated joints first, then the others, each block in pinocchio's order.

    Parameters
    ----------
    joints : sequence of Joint
        With their slices of pinocchio's q and delta_q.
    """
    ordered: list[Joint] = []
    entries_q: list[int] = []
    entries_v: list[int] = []
    for joint in sorted(joints, key=lambda joint: (not joint.actuated, joint.v.start)):
        q = range(joint.q.start, joint.q.stop)
        v = range(joint.v.start, joint.v.stop)
        slice_q = slice(len(entries_q), len(entries_q) + len(q))
        slice_v = slice(len(entries_v), len(entries_v) + len(v))
        ordered.append(replace(joint, q=slice_q, v=slice_v))
        entries_q += q
        entries_v += v
    return Order(tuple(ordered), np.array(entries_q, np.int64), np.array(entries_v, np.int64))
