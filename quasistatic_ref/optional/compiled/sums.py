"""(+) and (-) of joints: source/sums.c."""

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from quasistatic_ref.model.joints.axis_joint import Prismatic, Revolute
from quasistatic_ref.model.joints.continuous import Continuous
from quasistatic_ref.model.joints.floating import Floating
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.model.sums import Sums
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.compiled.library import addresses, function

KINDS: dict[type[Joint], int] = {Floating: 0, Planar: 1, Continuous: 2, Revolute: 3, Prismatic: 3}
"""Their numbers in C."""

Sum = Callable[[Array, Array], Array]


def plus(sums: Sums) -> Sum | None:
    """``Sums.plus`` in C; joints whose sines it cannot round are left to Python."""
    compiled = _of("plus", sums, sums.n_q)

    def answer(q: Array, delta_q: Array) -> Array:
        there, left = compiled(q, delta_q)
        for joint in left:
            there[joint.q] = joint.integrated(q[joint.q].tolist(), delta_q[joint.v].tolist())
        return there

    return answer if _all_known(sums) else None


def change(sums: Sums) -> Sum | None:
    """``Sums.change`` in C; joints whose angles it cannot round are left to Python."""
    compiled = _of("change", sums, sums.n_v)

    def answer(q: Array, q_next: Array) -> Array:
        change, left = compiled(q, q_next)
        for joint in left:
            change[joint.v] = joint.change(q[joint.q].tolist(), q_next[joint.q].tolist())
        return change

    return answer if _all_known(sums) else None


def _all_known(sums: Sums) -> bool:
    return all(type(joint) in KINDS for joint in sums.joints)


def _of(name: str, sums: Sums, size: int) -> Callable[[Array, Array], tuple[Array, list[Joint]]]:
    """A function of the library: what it writes, and the joints that it leaves open."""
    joints = sums.joints
    starts = [[KINDS.get(type(joint), 0), joint.q.start, joint.v.start] for joint in joints]
    table = np.reshape(np.array(starts, np.int64), (-1, 3)).T
    kept = addresses((np.array([len(joints)]), table))
    compiled = function(name)

    def answer(q: Array, other: Array) -> tuple[Array, list[Joint]]:
        written, left = np.empty(size), np.empty(len(joints), bool)
        if not compiled(*kept, *addresses((q, other), (written, left))):
            return written, []
        return written, [joints[j] for j in np.flatnonzero(left).tolist()]

    return answer


def trials_of_plus() -> list[tuple[Sums, tuple[Array, Array]]]:
    """A joint of each kind, moved far, a little, and not at all.

    q, shape (n_q,), and delta_q, (n_v,).
    """
    sums = Sums(_joints(KINDS))
    q = np.array([0.1, -0.2, 0.3, *QUATERNION, 0.4, 0.2, *TURN, 0.96, 0.28, 0.3, 1.5])
    delta_q = np.array([0.3, -0.1, 0.2, 0.7, -0.4, 1.1, 0.2, 0.1, 0.5, -0.3, 0.6, 0.02])
    return [(sums, (q, size * delta_q)) for size in (1.0, 1e-4, 0.0)]


def trials_of_change() -> list[tuple[Sums, tuple[Array, Array]]]:
    """Joints that are elsewhere, and as far around as can be.

    q and q_next, shape (n_q,) each.
    """
    sums = Sums(_joints(KINDS))
    q = np.array([0.1, -0.2, 0.3, *QUATERNION, 0.4, 0.2, *TURN, 0.96, 0.28, 0.3, 1.5])
    there = np.array([0.2, 0.1, -0.3, *QUATERNION[::-1], 0.1, 0.7, *TURN[::-1], *TURN, 0.1, 0.2])
    return [(sums, (q, there)), (sums, (there, q)), (sums, (q, q))]


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
