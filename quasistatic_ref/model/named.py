"""Entries of q and of delta_q by the names of bodies, joints and coordinates."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.model.joints.joint import COSINE_SINE, QUATERNION, Joint
from quasistatic_ref.model.rotation import quaternion
from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array, Indices, checked_array, checked_numbers

Values = Mapping[str, ArrayLike | Mapping[str, ArrayLike]]
"""Positions of joints and poses of bases by name, as :meth:`Named.placed` takes them."""


class Named:
    """Where the entries of named bodies, joints and coordinates stand in q and in delta_q.

    A body's name means all of its joints, ``arm/elbow`` one joint, ``mug/base`` a base. Single
    entries have the names of tables: of q ``mug.z`` and ``mug.qw``, of delta_q ``mug/base.rz``.

    Parameters
    ----------
    joints : sequence of Joint
        In the paper's order.
    """

    def __init__(self, joints: Sequence[Joint]) -> None:
        self._joints = {joint.name: joint for joint in joints}
        self._q: dict[str, list[int]] = {}
        self._change: dict[str, list[int]] = {}
        for joint in joints:
            q = range(joint.q.start, joint.q.stop)
            v = range(joint.v.start, joint.v.stop)
            body = joint.name.partition("/")[0]
            self._q.setdefault(body, []).extend(q)
            self._change.setdefault(body, []).extend(v)
            for name, i in zip(joint.positions, q, strict=True):
                self._q[name.partition(" ")[0]] = [i]
            for coordinate, i in zip(joint.coordinates, v, strict=True):
                self._change[coordinate.name] = [i]
            self._q[joint.name] = [*q]
            self._change[joint.name] = [*v]

    def q(self, name: str) -> Indices:
        """Indices of entries of q, and of q_a; ModelError if there is no such name."""
        return _indices(self._q, name)

    def change(self, name: str) -> Indices:
        """Indices of entries of delta_q, and of forces; ModelError if there is no such name."""
        return _indices(self._change, name)

    def placed(self, q: Array, values: Values) -> Array:
        """Copy of q, shape (n_q,), with named values.

        Parameters
        ----------
        q : ndarray, shape (n_q,)
        values : mapping of str to object
            Of a joint its position, a number [m, rad]; of a floating base, or of its body, a table
            of ``xyz`` [m] and ``rpy`` [rad]; of a planar one x, y [m] and the angle [rad]; of any
            name as many numbers as q holds of it.

        Raises
        ------
        ModelError
            If there is no such name, or a value is not of its kind.
        """
        placed = q.copy()
        for name, value in values.items():
            joint = self._joints.get(name, self._joints.get(f"{name}/base"))
            places = self.q(name if joint is None else joint.name)
            unit = None if joint is None else joint.unit
            if joint is not None and unit == QUATERNION and isinstance(value, Mapping):
                placed[places] = _pose(joint, name, value, placed[places])
                continue
            entries = np.atleast_1d(checked_numbers(value, name, ModelError))
            if unit == COSINE_SINE and len(entries) == len(places) - 1:
                entries = np.array([*entries[:-1], *cos_sin(float(entries[-1]))])
            if entries.shape != places.shape:
                wanted = "a number" if len(places) == 1 else f"{len(places)} numbers"
                raise ModelError(f"must be {wanted}", field=name, value=value)
            placed[places] = entries
        return placed


def _indices(known: Mapping[str, list[int]], name: str) -> Indices:
    if name not in known:
        problem = f"is not a body, joint or coordinate{suggestion(str(name), known)}"
        raise ModelError(problem, field="name", value=name)
    return np.array(known[name], dtype=np.int64)


def _pose(joint: Joint, name: str, pose: Mapping[str, ArrayLike], before: Array) -> Array:
    """Entries of q of a joint with a quaternion; what the table leaves out stays."""
    after = before.copy()
    known = ("xyz", "rpy") if joint.lengths else ("rpy",)
    for key, value in pose.items():
        if key not in known:
            raise ModelError(f"is unknown{suggestion(key, known)}", field=f"{name}.{key}")
        numbers = checked_array(value, f"{name}.{key}", (3,), ModelError)
        if key == "xyz":
            after[:3] = numbers
        else:
            after[joint.lengths :] = quaternion(numbers)
    return after
