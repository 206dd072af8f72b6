"""(+) of joints: source/sums.c."""

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from quasistatic_ref.model.joints.axis_joint import Prismatic, Revolute
from quasistatic_ref.model.joints.continuous import Continuous
from quasistatic_ref.model.joints.floating import Floating
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.model.sums import Sums
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.optional.compiled.addresses import addresses
from quasistatic_ref.optional.compiled.library import function

KINDS: dict[type[Joint], int] = {Floating: 0, Planar: 1, Continuous: 2, Revolute: 3, Prismatic: 3}
"""Their numbers in C."""

Sum = Callable[[Array, Array], Array]


def plus(sums: Sums) -> Sum | None:
    """``Sums.plus`` in C; joints whose sines it cannot round are left to Python."""
    if not all_known(sums):
        return None
    joints = sums.joints
    kept = addresses((np.array([len(joints)]), table(sums)))
    compiled = function("plus")

    def answer(q: Array, delta_q: Array) -> Array:
        there = np.empty(sums.n_q)
        left = np.empty(len(joints), bool)
        if compiled(*kept, *addresses((q, delta_q), (there, left))):
            for joint in [joints[j] for j in np.flatnonzero(left).tolist()]:
                there[joint.q] = joint.integrated(q[joint.q].tolist(), delta_q[joint.v].tolist())
        return there

    return answer


def all_known(sums: Sums) -> bool:
    """Whether C knows all of their joints."""
    return all(type(joint) in KINDS for joint in sums.joints)


def table(sums: Sums) -> Indices:
    """The kinds of joints, where their entries of q start, and where those of delta_q: (3, k)."""
    starts = [[KINDS[type(joint)], joint.q.start, joint.v.start] for joint in sums.joints]
    return np.reshape(np.array(starts, np.int64), (-1, 3)).T


def trials_of_plus() -> list[tuple[Sums, tuple[Array, Array]]]:
    """A joint of each kind, moved far, a little, and not at all.

    q, shape (n_q,), and delta_q, (n_v,).
    """
    sums = Sums(_joints(KINDS))
    q = np.array([0.1, -0.2, 0.3, *QUATERNION, 0.4, 0.2, *TURN, 0.96, 0.28, 0.3, 1.5])
    delta_q = np.array([0.3, -0.1, 0.2, 0.7, -0.4, 1.1, 0.2, 0.1, 0.5, -0.3, 0.6, 0.02])
    return [(sums, (q, size * delta_q)) for size in (1.0, 1e-4, 0.0)]


QUATERNION = (0.1, 0.5, -0.7, 0.5)
TURN = (0.6, -0.8)


def _joints(kinds: Iterable[type[Joint]]) -> list[Joint]:
    """A joint of each kind, one after another."""
    joints: list[Joint] = []
    q = v = 0
    for kind in kinds:
        joint = kind("j", True, slice(0), slice(0))
        sizes = len(joint.neutral()), len(joint.coordinates)
        joints.append(replace(joint, q=slice(q, q + sizes[0]), v=slice(v, v + sizes[1])))
        q, v = joints[-1].q.stop, joints[-1].v.stop
    return joints
