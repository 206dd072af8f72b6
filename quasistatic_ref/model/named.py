"""Entries of q and of delta_q by the names of bodies, joints and coordinates."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError, ModelError, check_kind
from quasistatic_ref.model.joints.joint import COSINE_SINE, QUATERNION, Joint
from quasistatic_ref.model.rotation import quaternion
from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array, Indices, checked_array, checked_numbers
from quasistatic_ref.quoting import clipped, suggestion

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
        self._q = _Places((j, j.q, [position.name for position in j.positions]) for j in joints)
        self._change = _Places((j, j.v, [entry.name for entry in j.coordinates]) for j in joints)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {clipped(', '.join(self._joints)) or 'no joints'}>"

    def q(self, name: str) -> Indices:
        """Indices of entries of q, and of q_a; ModelError if there is none of that name, or two."""
        return self._q.indices(name)

    def change(self, name: str) -> Indices:
        """Indices of entries of delta_q, and of forces; ModelError as of :meth:`q`."""
        return self._change.indices(name)

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
            If there is no such name, it has two meanings, two names share an entry, or a value is
            not of its kind.
        """
        check_kind(values, Mapping, "values", "a mapping of names")
        placed = q.copy()
        check_apart({name: self.q(name) for name in values}, "{}")
        for name, value in values.items():
            joint = self._joints.get(name, self._joints.get(f"{name}/base"))
            places = self.q(name)
            if joint is not None:
                places = self.q(joint.name)
            unit = None if joint is None else joint.unit_vector
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


def check_apart(
    places: Mapping[str, Indices], field: str, error: type[InputError] = ModelError
) -> None:
    """Refuse two names of one entry, of which the later would replace what the first one says.

    Parameters
    ----------
    places : mapping of str to ndarray of int, shape (k,)
        The entries of each name.
    field : str
        What messages call a name, with ``{}`` in its place.
    error : type
        The :class:`~quasistatic_ref.errors.InputError` to raise.

    Raises
    ------
    InputError
        Naming both.
    """
    named_by: dict[int, str] = {}
    for name, entries in places.items():
        for i in entries.tolist():
            other = named_by.setdefault(i, name)
            if other != name:
                problem = f"names something that {other!r} names, too; give each value once"
                raise error(problem, field=field.format(name))


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


class _Places:
    """Indices of entries by the names of bodies, joints and entries.

    Parameters
    ----------
    joints : iterable of tuple
        Each joint, where its entries stand, and their names.
    """

    def __init__(self, joints: Iterable[tuple[Joint, slice, Sequence[str]]]) -> None:
        self._meanings: dict[str, dict[tuple[int, ...], str]] = {}
        bodies: dict[str, list[int]] = {}
        for joint, place, names in joints:
            entries = range(place.start, place.stop)
            bodies.setdefault(joint.name.partition("/")[0], []).extend(entries)
            self._add(joint.name, entries, f"the joint {joint.name}")
            for name, i in zip(names, entries, strict=True):
                self._add(name, [i], f"an entry of {joint.name}")
        for body, of_body in bodies.items():
            self._add(body, of_body, f"the body {body}")

    def _add(self, name: str, entries: Sequence[int], meaning: str) -> None:
        self._meanings.setdefault(name, {}).setdefault(tuple(entries), meaning)

    def indices(self, name: str) -> Indices:
        check_kind(name, str, "name", "a name")
        if name not in self._meanings:
            problem = f"is not a body, joint or coordinate{suggestion(str(name), self._meanings)}"
            raise ModelError(problem, field="name", value=name)
        entries, *others = self._meanings[name]
        if others:
            meanings = " or ".join(self._meanings[name].values())
            problem = f"can mean {meanings}; ask for a whole joint, or rename one of them"
            raise ModelError(problem, field="name", value=name)
        return np.array(entries, dtype=np.int64)
