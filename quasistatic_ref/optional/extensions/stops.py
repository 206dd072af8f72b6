"""Stops at joint limits: rows of a step, certified as any others, whose multipliers are forces."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import compress

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.model.joints import JOINTS
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Indices, Mask, freeze_copies
from quasistatic_ref.optional.extensions.urdf_joints import urdf_joints
from quasistatic_ref.step.data import Extra
from quasistatic_ref.text.plain import Plain


@dataclass(frozen=True, eq=False)
class JointLimits(Plain):
    """Least and greatest positions of joints, lower <= q_i <= upper.

    Parameters
    ----------
    names : tuple of str, length c
        Of the joints.
    places : ndarray of int, shape (c,)
        Their entries of q.
    coordinates : ndarray of int, shape (c,)
        Their entries of delta_q.
    lower, upper : ndarray, shape (c,)
        [m, rad]; an infinite one has no row.
    n_v : int
    """

    names: tuple[str, ...]
    places: Indices
    coordinates: Indices
    lower: Array
    upper: Array
    n_v: int

    def __post_init__(self) -> None:
        freeze_copies(self, "places", "coordinates", "lower", "upper")

    def __len__(self) -> int:
        return len(self.names)

    def rows(self, q: Array) -> Extra:
        """The stops at q, shape (n_q,): delta_q_i >= lower - q_i, and -delta_q_i >= q_i - upper.

        The multiplier of a row over h is the force of its stop [N, N m].
        """
        at = q[self.places]
        b = np.concatenate([self.lower - at, at - self.upper])
        return Extra(*self._of_every_q, b[self._finite])

    @cached_property
    def _finite(self) -> Mask:
        """Mask of the limits that are finite: the lower ones, then the upper ones, shape (2 c,)."""
        finite: Mask = np.isfinite(np.concatenate([self.lower, self.upper]))
        return finite

    @cached_property
    def _of_every_q(self) -> tuple[tuple[str, ...], Array]:
        """Names and matrix A of the stops' rows, which do not depend on q."""
        c = len(self)
        A = np.zeros((2, c, self.n_v))
        A[0, np.arange(c), self.coordinates] = 1.0
        A[1, np.arange(c), self.coordinates] = -1.0
        names = [f"{name} at its {end} limit" for end in ("lower", "upper") for name in self.names]
        kept = self._finite
        return tuple(compress(names, kept)), A.reshape(2 * c, self.n_v)[kept]

    def check_start(self, q: Array) -> None:
        """Check that no joint is beyond its limits at q, shape (n_q,); InputError naming it."""
        at = q[self.places]
        for i in np.flatnonzero((at < self.lower) | (at > self.upper)):
            problem = (
                f"starts beyond its limits, {self.lower[i]:.6g} to {self.upper[i]:.6g}; change the "
                "start, or leave out joint_limits"
            )
            raise InputError(problem, field=self.names[i], value=float(at[i]))


def urdf_limits(system: System, bodies: Collection[str]) -> dict[str, tuple[float, float]]:
    """What ``<limit>`` says of the joints of some bodies, by their names [m, rad].

    A joint that mimics another limits that one: multiplier * q + offset stays within its limits.
    Where both bounds are missing there is none, where one is missing it is 0; bounds that are both
    0 hold the joint.

    Raises
    ------
    InputError
        If a lower limit is above the upper one, or a joint has no position within its limits and
        those of the joints that mimic it; or one that stands still is beyond its limits.
    """
    limits: dict[str, tuple[float, float]] = {}
    for joint in urdf_joints(system, bodies):
        limit = joint.tag.perhaps("limit")
        kind = JOINTS[joint.tag.text("type")]
        if limit is None or kind.unit_vector:  # it has no place of one number
            continue
        ends = limit.position_limits()
        if ends is None:
            continue
        if ends[0] > ends[1]:
            problem = f"its lower limit is above its upper one, {ends[1]:.6g}"
            raise InputError(problem, field=joint.name, value=ends[0])
        if joint.multiplier == 0:
            if not ends[0] <= joint.offset <= ends[1]:
                problem = f"stands still beyond its limits, {ends[0]:.6g} to {ends[1]:.6g}"
                raise InputError(problem, field=joint.name, value=joint.offset)
            continue
        low, high = sorted((end - joint.offset) / joint.multiplier for end in ends)
        before = limits.get(joint.leader, (-np.inf, np.inf))
        limits[joint.leader] = max(low, before[0]), min(high, before[1])
    for name, (low, high) in limits.items():
        if low > high:
            problem = "has no position within its limits and those of the joints that mimic it"
            raise InputError(problem, field=name, value=[low, high])
    return limits


def stops_of(system: System, limits: Mapping[str, tuple[float, float]]) -> JointLimits:
    """The stops of joints at limits, lower and upper [m, rad], by the joints' names.

    Parameters
    ----------
    system : System
    limits : mapping of str to (float, float)
        Name of a joint -> its least and greatest position [m, rad].
    """
    joints = {joint.name: joint for joint in system.joints}
    limited = [joints[name] for name in limits]
    return JointLimits(
        names=tuple(limits),
        places=np.array([joint.q.start for joint in limited], dtype=np.int64),
        coordinates=np.array([joint.v.start for joint in limited], dtype=np.int64),
        lower=np.array([low for low, _ in limits.values()]),
        upper=np.array([high for _, high in limits.values()]),
        n_v=system.n_v,
    )
