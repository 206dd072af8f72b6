"""A configuration q from outside, checked before anything is computed from it.

pinocchio and coal compute on with a quaternion of any length, and say nothing: at length 2 a box's
gaps are those of a larger box, and the optimum of its step is proved for these gaps.
"""

from collections.abc import Sequence
from itertools import accumulate
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.numbers.arrays import Array, checked_numbers
from quasistatic_ref.numbers.ordered import length, norm

UNIT_QUATERNION: Final = 1e-9
"""Largest | |x| - 1 | of a quaternion, or of a pair (cos, sin), that is taken for a unit one.

A length 1 + e changes lever arms by 2 e of themselves, so that 1e-9 changes a gap under an arm of
0.1 m by 2e-10 m. 10^6 steps leave less; float32 leaves up to 6e-8, and is refused with a remedy."""

UNIT_ROUNDING: Final = 1e-15
"""Largest | |x| - 1 | that is left alone: normalising in float64 leaves up to two units of 2.2e-16
in the length as computed, so that what was normalised once is not touched again."""

W_FIRST = [1.0, 0.0, 0.0, 0.0]
"""The quaternion of no turn where w comes first, as in MuJoCo and Drake."""


def configuration(joints: Sequence[Joint], n_q: int, q: ArrayLike) -> Array:
    """Copy of q, finite, of shape (n_q,), its quaternions of length one.

    What is off by rounding alone keeps its bits, so that a recorded q replays as it was; between
    that and what :class:`UnitParts` refuses, a quaternion is divided by its length.

    Raises
    ------
    ModelError
        If it is not a configuration; the message names the joint.
    """
    checked = _finite_entries(joints, n_q, q)
    UnitParts(joints).check(checked)
    for joint in joints:
        if joint.unit_vector and checked[joint.unit_part].tolist() == W_FIRST:
            problem = (
                "looks like the identity as [w x y z]; quaternions are [x y z w], and the identity "
                "is [0 0 0 1] (half a turn about x is [1 0 0 1e-16])"
            )
            raise ModelError(problem, field=f"q[{joint.name}]", value=W_FIRST)
    return normalised(joints, checked)


def unit_configuration(joints: Sequence[Joint], n_q: int, q: ArrayLike) -> Array:
    """A finite copy of q, shape (n_q,), with quaternions scaled to length one.

    Raises
    ------
    ModelError
        If a number is not finite, the shape another one, or a length zero.
    """
    checked = _finite_entries(joints, n_q, q)
    for joint in joints:
        if joint.unit_vector and not checked[joint.unit_part].any():
            problem = f"its {joint.unit_vector} must not have length 0, which gives no direction"
            value = checked[joint.unit_part].tolist()
            raise ModelError(problem, field=f"q[{joint.name}]", value=value)
    return normalised(joints, checked)


def surely_configurations(joints: Sequence[Joint], q: Array) -> bool:
    """Whether :func:`configuration` would surely change nothing but signs of zeros.

    Parameters
    ----------
    joints : sequence of Joint
        All, or the first of them.
    q : ndarray, shape (..., n)
        The entries of these joints in each of several q.
    """
    if not np.isfinite(q).all():
        return False
    for joint in joints:
        unit = q[..., joint.unit_part]
        if joint.unit_vector and not (np.abs(norm(unit) - 1) <= UNIT_ROUNDING).all():
            return False
        if unit.shape[-1] == len(W_FIRST) and (unit == W_FIRST).all(axis=-1).any():
            return False
    return True


class UnitParts:
    """The quaternions, and pairs (cos, sin), of joints: each must have length one.

    Parameters
    ----------
    joints : sequence of Joint
        Those without such a part are skipped.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        self._joints = [joint for joint in joints if joint.unit_vector]
        parts = [np.arange(joint.q.stop)[joint.unit_part] for joint in self._joints]
        self._entries = np.concatenate([np.zeros(0, np.int64), *parts])
        self._starts = np.array([0, *accumulate(map(len, parts))][:-1], np.int64)

    def check(self, q: Array) -> None:
        """Refuse a part whose length is off by more than rounding.

        Parameters
        ----------
        q : ndarray
            All entries of q, or the first of them, those of these joints; perhaps of many q.

        Raises
        ------
        ModelError
            It names the joint, the length, and what divides by it.
        """
        if not self._joints:
            return
        squares = np.square(q.take(self._entries, axis=-1))
        squares = np.add.reduceat(squares, self._starts, axis=-1)
        off = squares.ravel() - 1.0  # by more than the length is
        if off.dot(off) < UNIT_QUATERNION * UNIT_QUATERNION / 4:
            return
        lengths = np.sqrt(squares)
        wrong = np.abs(lengths - 1) > UNIT_QUATERNION
        if not wrong.any():
            return
        if q.ndim > 1:
            self.check(q[wrong.any(axis=1).argmax()])
        first = int(wrong.argmax())
        joint = self._joints[first]
        problem = (
            f"its {joint.unit_vector} must have length one, not {lengths[first]:.10g}; "
            "system.normalised(q) divides it by its length"
        )
        raise ModelError(problem, field=f"q[{joint.name}]", value=q[joint.unit_part].tolist())


def normalised(joints: Sequence[Joint], q: Array) -> Array:
    """A copy of q, shape (n_q,), whose quaternions of any length are scaled to length one.

    Those that are of length one but for rounding keep their bits, and those of length zero stay.

    Parameters
    ----------
    joints : sequence of Joint
    q : ndarray, shape (n_q,)
    """
    entries = q + 0.0
    for joint in joints:
        if joint.unit_vector:
            unit = entries[joint.unit_part]
            size = length(unit)
            if size > 0 and abs(size - 1) > UNIT_ROUNDING:
                unit /= size
    return entries


def _finite_entries(joints: Sequence[Joint], n_q: int, q: ArrayLike) -> Array:
    """The numbers of q, if finite and of shape (n_q,); ModelError else, which names the joint."""
    entries = checked_numbers(q, "q", ModelError)
    if entries.shape != (n_q,):
        raise ModelError(f"must have shape ({n_q},)", field="q", value=entries.shape)
    for joint in joints:
        part = entries[joint.q]
        if not np.isfinite(part).all():
            raise ModelError("must be finite", field=f"q[{joint.name}]", value=part.tolist())
    return entries
