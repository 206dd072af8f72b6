"""The forces of single contacts in fixed point: those of ``optional/forces``, if it is there."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property, partial
from itertools import accumulate, combinations
from operator import attrgetter
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.certify.contact_forces import ForcesOfGroups, forces_near
from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.optional.between import FACE, SIDES
from quasistatic_ref.optional.fast.compiled.certificate import (
    Places,
    group_proof,
    places,
    write_data,
    zeros_for_step,
)
from quasistatic_ref.optional.fast.compiled.library import library, why_not
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.optional.fast.posed import posed
from quasistatic_ref.optional.fast.proofs import Coupling, coupled_by, unchanged
from quasistatic_ref.optional.fast.rechecked import check_forces
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.solve.units import hessian_in_both_units
from quasistatic_ref.step.arrays import read_only
from quasistatic_ref.step.cones import cone, cone_matrix
from quasistatic_ref.step.data import Array, Indices, StepData
from quasistatic_ref.step.groups import Group, group_steps

MOST_ROWS = 8
"""Of a contact: C looks a face up by the set of its rows."""
WRENCHES = ("near", "wrench")
LARGEST = 1 << 30
"""What the whole numbers of a face are below."""


class Forces:
    """The forces of steps that have their H, rows and groups in common.

    Parameters
    ----------
    step : StepData
        One of them, in a polyhedral cone.
    """

    def __init__(self, step: StepData) -> None:
        divided = group_steps(step)
        self._form = library().groups_forces
        self._none = np.zeros((step.contacts.n_c, 4))
        self.groups = [group for group, _ in divided]
        of_each = places(step, None, self.groups)
        self.parts = [
            _GroupForces(*one, where) for one, where in zip(divided, of_each, strict=True)
        ]
        self.s = Structure("groups.c", "Step")
        self.s.put(
            {
                "groups": len(divided), "code": np.zeros(len(divided), np.int64),
                "group": np.array([part.group for part in self.parts], np.int64),
                "forces": np.array([part.s.address for part in self.parts], np.int64),
                "J": np.array(step.contacts.kept_J),
                **{name: np.zeros((step.contacts.n_c, 4)) for name in WRENCHES},
            }
        )  # fmt: skip
        zeros_for_step(self.s, step.n_a, step.n_v, step.contacts.n_c, step.m)

    def in_c(self, step: StepData, near: Array | None = None) -> tuple[Array, list[int]]:
        """(f_d1, f_d2, f_n, tau_n) of each contact of a step, shape (n_c, 4) [N, N m].

        With the numbers of the groups that C leaves open, whose forces here mean nothing.

        Parameters
        ----------
        step : StepData
        near : ndarray, shape (n_c, 4), optional
            The same without compliance: where to seek [N, N m].
        """
        write_data(self.s, step)
        self.s.write("near", self._none if near is None else near)
        self._form(self.s.address)
        left = self.s.integers("code").nonzero()[0].tolist()
        return self.s["wrench"].copy(), [i for i in left if len(self.groups[i].contacts)]

    def of_block(
        self, first: StepData, records: NDArray[np.void], near: Array
    ) -> tuple[Array, NDArray[np.int64]]:
        """The same of steps that follow one another, with what becomes of each of their groups.

        Parameters
        ----------
        first : StepData
            One of them.
        records : ndarray, shape (steps,)
            As of :class:`~quasistatic_ref.optional.fast.compiled.onward.Onward` [of the notation].
        near : ndarray, shape (steps, n_c, 4)
            As of :meth:`in_c` [N, N m].

        Returns
        -------
        ndarray, shape (steps, n_c, 4)
            [N, N m].
        ndarray, shape (steps, groups)
            As in proof.h.
        """
        self.s["mu"][:, 1:] = first.contacts.mu
        scene = records["scene"]
        frame = np.zeros((*near.shape, 4))
        frame[..., 3, 3] = 1.0
        for i, name in enumerate(("n", "d1", "d2")):
            frame[..., i, :3] = scene[name]
        wrench = np.zeros(near.shape)
        code = np.zeros((len(records), len(self.groups)), np.int64)
        s = Structure("groups.c", "Step")
        s.put({"groups": len(self.groups)})
        s.share(self.s, ("group", "forces", "mu"))
        for _ in s.along(
            {
                **{name: scene[name] for name in ("J", "phi", "tau")}, "frame": frame,
                "delta_q_bar_a": records["delta_q_bar_a"], "near": np.ascontiguousarray(near),
                "code": code, "wrench": wrench,
            }
        ):  # fmt: skip
            self._form(s.address)
        return wrench, code

    def compliance(self) -> Array:
        """Of each contact in the last step of :meth:`in_c`, which has decided all, (n_c,) [m/N]."""
        found = np.zeros(len(self._none))
        for group, part in zip(self.groups, self.parts, strict=True):
            if len(group.contacts):
                found[group.contacts] = part.s["compliance"]
        return found

    def wrench(self, step: StepData, near: tuple[Array, Array]) -> Array:
        """The same, shape (n_c, 4); what C leaves open comes from the core.

        Parameters
        ----------
        step : StepData
        near : (ndarray, ndarray)
            delta_q, (n_v,) [m, rad], and wrenches, (n_c, 4) [N, N m], as of its solution.
        """
        delta_q, wrenches = near
        wrench, left = self.in_c(step, wrenches)
        for group, own in [group_steps(step)[i] for i in left]:
            of_group = delta_q[group.coordinates], wrenches[group.contacts]
            wrench[group.contacts] = forces_near(own, of_group).wrench
        if not left:
            check_forces(lambda: step, step.n_v, wrench)
        return read_only(wrench)


class ForcesOfSteps:
    """The forces of one step after the other, in any thread: what they have in common is kept."""

    def __init__(self) -> None:
        self._of: Coupling = []
        self._kept: Forces | None = None
        self._one_at_a_time = Lock()

    def __reduce__(self) -> tuple[type["ForcesOfSteps"], tuple[()]]:
        return ForcesOfSteps, ()  # a copy forms what it keeps itself

    def wrench(self, step: StepData, near: tuple[Array, Array]) -> Array:
        """As of :meth:`Forces.wrench`, which has `near`, too: shape (n_c, 4) [N, N m]."""
        with self._one_at_a_time:
            return self._of_steps_like(step).wrench(step, near)

    def of_block(
        self, results: Sequence[StepResult], records: NDArray[np.void], near: Array
    ) -> Array:
        """The same of steps that follow one another: shape (steps, n_c, 4) [N, N m].

        Parameters
        ----------
        results : sequence of StepResult
            Of which few are made.
        records : ndarray, shape (steps,)
            As of :meth:`Forces.of_block` [of the notation].
        near : ndarray, shape (steps, n_c, 4)
            The same [N, N m].
        """

        def step_of(k: int) -> StepData:
            return results[k].step

        moving = np.asarray(records["scene"]["J"].any(axis=2))
        if (moving != moving[0]).any():
            each = zip(results, records["delta_q"], near, strict=True)
            return np.array([self.wrench(one.step, (delta_q, own)) for one, delta_q, own in each])
        with self._one_at_a_time:
            step = results[0].step
            forces = self._of_steps_like(step)
            wrench, code = forces.of_block(step, records, near)
        known = [i for i, group in enumerate(forces.groups) if len(group.contacts)]
        left_open = np.asarray(code[:, known].any(axis=1))
        for k, left in enumerate(left_open.tolist()):
            if left:
                wrench[k] = self.wrench(results[k].step, (records["delta_q"][k], near[k]))
            else:
                check_forces(partial(step_of, k), step.n_v, wrench[k])
        return wrench

    def decided(self, step: StepData, near: Array) -> ForcesOfGroups | None:
        """The same; None if a force is open.

        Parameters
        ----------
        step : StepData
        near : ndarray, shape (n_c, 4)
            As of :meth:`Forces.in_c` [N, N m].
        """
        with self._one_at_a_time:
            forces = self._of_steps_like(step)
            wrench, left = forces.in_c(step, near)
            if left:
                return None
            compliance = forces.compliance()
        check_forces(lambda: step, step.n_v, wrench)
        return read_only(wrench), read_only(compliance), forces.groups

    def _of_steps_like(self, step: StepData) -> Forces:
        of = coupled_by(step)
        if self._kept is None or not unchanged(of, self._of):
            self._kept = Forces(step)
            self._of = of
        return self._kept


@dataclass(frozen=True, eq=False, repr=False)
class FastSolution(StepSolution):
    """A solution whose forces come from compiled code: the same, in less time.

    Parameters
    ----------
    in_c : ForcesOfSteps or None
        Not compared.
    """

    in_c: ForcesOfSteps | None = field(default=None, compare=False)

    @cached_property
    def forces(self) -> Array:
        """As of the base, shape (n_c, 4) [N, N m]."""
        if self.in_c is None or why_not() is not None:  # where a copy is read, C may be missing
            return super().forces
        return self.in_c.wrench(self.step, (self.delta_q, self.wrench))

    @classmethod
    def compared_as(cls) -> type:
        """It is compared as :class:`~quasistatic_ref.certify.solution.StepSolution`."""
        return StepSolution


def with_forces(solution: StepSolution, in_c: ForcesOfSteps) -> FastSolution:
    """The same solution, whose forces come from compiled code."""
    names = StepSolution.kept()
    values = attrgetter(*names)(solution)
    return posed(FastSolution, dict(zip(names, values, strict=True)), {"in_c": in_c})


def knows(name: str) -> bool:
    """Whether C knows the faces of a polyhedral cone."""
    return all(_faces(name, count) for count in cone(name).counts(np.array([4, 6])).tolist())


class _GroupForces:
    """What C knows of the forces of a group, whose step is its `own`.

    Attributes
    ----------
    s : Structure
    proof : GroupProof or None
        Of its H and rows; None where C proves nothing.
    group : int
        Address of its Proof; 0 of a group that C does not know.
    """

    def __init__(self, group: Group, own: StepData, where: Places) -> None:
        n_c = own.contacts.n_c
        self.s = Structure("forces.h", "Forces")
        self.s.put({name: np.zeros((n_c, 4)) for name in WRENCHES})
        counts, kind = np.unique(own.counts, return_inverse=True)
        known = [_faces(own.cone, count) for count in counts.tolist()]
        tables = [table for table in known if table is not None]
        self.proof = group_proof(group, own, hessian_in_both_units(own.H), where)
        if not n_c or None in known or self.proof is None:
            self.group = 0
            return
        self.group = self.proof.s.address
        of_sides = SIDES.needed("forces")(own)
        integers = [each for each, _ in tables]
        width = max(each.shape[1] for each in integers)
        firsts = np.array([0, *accumulate(map(len, integers))])
        table = np.zeros((firsts[-1], width, 4), np.int64)
        for i, each in zip(firsts.tolist(), integers, strict=False):
            table[i : i + len(each), : each.shape[1]] = each
        denominators = np.concatenate([each for _, each in tables])
        self.s.put(
            {
                "width": width, "sides": len(of_sides), "count": own.counts,
                "first": firsts[kind], "face": np.zeros(n_c, np.int64),
                "table": table,
                "denominator": denominators,
                "multiple": int(np.lcm.reduce(denominators[denominators > 0])),
                "side": np.concatenate(of_sides),
                "start": np.array([0, *accumulate(map(len, of_sides))]),
                "compliance": np.zeros(1),
                "bears": np.asarray(cone_matrix(own.cone)[:, :3].any(axis=0), np.int64),
            }
        )  # fmt: skip
        self.s.put({"group": self.group})


@cache
def _faces(name: str, count: int) -> tuple[Indices, Indices] | None:
    """The faces of a contact that has `count` rows, by the bits of the rows that span them.

    Returns
    -------
    (ndarray, ndarray) or None
        Their numbers as of :class:`~quasistatic_ref.optional.forces.faces.Face`, shape
        (2^count, count + 4, 4), and denominators, (2^count,), zero of rows that depend on each
        other. None if C cannot hold them.
    """
    face = FACE.found()
    if face is None or count > MOST_ROWS:
        return None
    integers = np.zeros((1 << count, count + 4, 4), np.int64)
    denominators = np.zeros(1 << count, np.int64)
    for size in range(5):
        for rows in combinations(range(count), size):
            found = face(name, count, rows)
            if found is None:
                continue
            numbers, denominator = found
            if abs(numbers).max() >= LARGEST or denominator >= LARGEST:
                return None
            bits = sum(1 << i for i in rows)
            integers[bits] = numbers
            denominators[bits] = denominator
    return integers, denominators
