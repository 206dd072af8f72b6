"""Proofs of steps, group by group, with what is kept while groups and H stay."""

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum, check_length, group_optimum, joined_optimum
from quasistatic_ref.certify.norm import EnergyNorm, Norm
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.optional.fast.compiled.certificate import GroupProof, Prover
from quasistatic_ref.optional.fast.compiled.library import why_not
from quasistatic_ref.optional.fast.far import (
    Balls,
    Solved,
    balls,
    displacement,
    far_slacks,
    with_far,
)
from quasistatic_ref.optional.fast.posed import (
    Constants,
    constants,
    posed,
)
from quasistatic_ref.optional.fast.rechecked import GROUP, WHOLE, check, is_due
from quasistatic_ref.solve.solver import NaturalAnswer
from quasistatic_ref.solve.units import (
    DenseStepInBothUnits,
    HessianInBothUnits,
    StepInBothUnits,
    hessian_in_both_units,
)
from quasistatic_ref.step.arrays import read_only
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import Array, Indices, Mask, StepData
from quasistatic_ref.step.groups import Group, extra_rows, group_steps, groups, split
from quasistatic_ref.tolerances import ILL_POSED

SMALL = 24
"""Coordinates up to which a group is not divided further, by the contacts that do not touch."""

TOUCHING = 1e-6
"""Slack of a row, in natural units, up to which its contact may touch [-]."""

Coupling: TypeAlias = "list[Array | Indices | bytes | float | str]"
"""What couples the coordinates of a step, and how."""


@dataclass(frozen=True, eq=False)
class GroupNorm:
    """The norm of a step of several groups, from that of each.

    Parameters
    ----------
    parts : list of (ndarray of int or slice, EnergyNorm)
        Coordinates of each group, and its norm.
    """

    parts: list[tuple[Indices | slice, EnergyNorm]]

    def of_displacement(self, v: Array) -> float:
        """||v||_H of a displacement v, shape (n_v,) [m, rad]; its square is in [N m s]."""
        return math.hypot(*(norm.of_displacement(v[own]) for own, norm in self.parts))

    def of_impulse(self, p: Array) -> float:
        """||H^-1 p||_H of an impulse p, shape (n_v,) [N s, N m s]."""
        return math.hypot(*(norm.of_impulse(p[own]) for own, norm in self.parts))


class Kept:
    """What proofs of steps keep while H, and the rows of contacts, stay."""

    def __init__(self) -> None:
        self.hessian: HessianInBothUnits | None = None

    @property
    def norm(self) -> EnergyNorm:
        """The norm ||.||_H of the last step."""
        assert self.hessian is not None
        return self.hessian.norm


@dataclass(frozen=True, eq=False)
class KeptGroup:
    """A group of a step, and what its steps have in common.

    Parameters
    ----------
    group : Group
    constant : Constants or None
        Of its steps; None where the group is the whole step.
    kept : Kept
        Shared by groups of equal constants.
    key : tuple
        All that shapes what is kept: the constants, and the number of rows of the user's own.
    """

    group: Group
    constant: Constants | None
    kept: Kept
    key: tuple[object, ...] = ()

    @property
    def coordinates(self) -> Indices | slice:
        """The coordinates of the group; all, without an index, where it is the whole step."""
        return slice(None) if self.constant is None else self.group.coordinates

    def optimum(
        self, whole: StepInBothUnits, lam: Array, slack: Array, in_c: GroupProof | None
    ) -> ExactOptimum:
        """The exact optimum of the group, by C or by the exact method.

        Parameters
        ----------
        whole : StepInBothUnits
            The whole step.
        lam, slack : ndarray, shape (m,)
            Of an answer to it, both in natural units [-].
        in_c : GroupProof or None
            What C has proved of the group already.

        Raises
        ------
        StepInfeasible
        """
        decided = None if in_c is None else in_c.decided()
        rows = self.group.rows
        if decided is None:
            own = self.in_both_units(whole)
            decided = None if in_c is None else in_c.nearby(own.units)
        if decided is not None:
            if is_due(GROUP, len(self.group.coordinates)):
                check(self.step(whole.si_step), decided)
            return decided
        if in_c is None:
            start = warm_rows(own.natural_form.A, lam[rows], slack[rows])
        else:
            start = in_c.guess.tolist()
        return group_optimum(whole.si_step, self.group, own.si_step, start)

    def hessian(self, whole: StepInBothUnits) -> HessianInBothUnits:
        """H of the group, from the `whole` step."""
        if self.constant is None:
            return self.in_both_units(whole).hessian
        known = self.kept.hessian
        if known is None or known.H is not self.constant.H:
            self.kept.hessian = known = hessian_in_both_units(self.constant.H)
        return known

    def in_both_units(self, whole: StepInBothUnits) -> DenseStepInBothUnits:
        """The step of the group in its own natural units, from the `whole` step."""
        both = whole
        if self.constant is not None or not isinstance(both, DenseStepInBothUnits):
            both = DenseStepInBothUnits(self.step(whole.si_step), self.kept.hessian)
        self.kept.hessian = both.hessian
        return both

    def step(self, step: StepData) -> StepData:
        """The step of the group, from the whole `step`."""
        constant = self.constant
        if constant is None:
            return step
        group = self.group
        given = step.contacts
        a, u = split(step, group)
        j = group.contacts
        if len(group.extra_rows):
            constant = constant._replace(extra=extra_rows(step, group))
        of_contacts = {
            name: read_only(getattr(given, name)[j])
            for name in ("phi", "n", "d1", "d2", "mu_v", "mu_omega", "rows")
        }
        names = tuple([given.name[i] for i in j.tolist()])
        J = read_only(given.columns(j, group.coordinates))
        loads = {
            "tau_a": read_only(step.tau_a[a]),
            "tau_u": read_only(step.tau_u[u]),
            "delta_q_bar_a": read_only(step.delta_q_bar_a[a]),
        }
        contacts = posed(Contacts, of_contacts, {"name": names, "J": J})
        return posed(StepData, constant.fields(), {**loads, "contacts": contacts})


class Proofs:
    """The exact optimum of one step after the other, each group of a step proved by itself.

    Attributes
    ----------
    parts : list of KeptGroup
        The groups of the last step.
    """

    def __init__(self) -> None:
        self.parts: list[KeptGroup] = []
        self._of_parts: Coupling = []
        self._of_groups: Coupling = []
        self._found: list[Group] = []
        self._small: Mask | None = None  # contacts of small groups; None if all are
        self.prover: Prover | None = None

    def norms(self) -> list[tuple[Indices | slice, EnergyNorm]]:
        """Coordinates of each group of the last step, and its norm."""
        return [(part.coordinates, part.kept.norm) for part in self.parts]

    def norm(self) -> Norm:
        """The norm ||.||_H of the last step."""
        return GroupNorm(self.norms())

    def optimum(self, both: StepInBothUnits, answer: NaturalAnswer | None) -> ExactOptimum:
        """The exact optimum: proved on a guess of its working set, or found by the exact method.

        Raises
        ------
        StepInfeasible, StepIllPosed
        """
        step = both.si_step
        form = both.natural_form
        if answer is None:
            lam = np.zeros(step.m)
            slack = np.zeros(step.m)
        else:
            lam = answer.natural_lam
            slack = form.A @ answer.natural_delta_q - form.b
        coupling = coupled_by(step)
        near = self._near(step, coupling, lam, slack)
        while True:
            parts = self.divided(step, near, coupling)
            prover = self._prover(both)
            optimum = None if prover is None else prover.optimum(both, lam, slack)
            in_c = None if optimum is None else prover
            if in_c is not None and is_due(WHOLE, len(parts[0].group.coordinates)):
                first = in_c.proofs[0]
                decided = first.decided() if first else None
                assert decided is not None
                check(parts[0].step(step), decided)
            if optimum is None:
                tried = [None] * len(parts) if prover is None else prover.proofs
                each = zip(parts, tried, strict=True)
                optima = [part.optimum(both, lam, slack, proof) for part, proof in each]
                optimum = joined_optimum(step, [part.group for part in parts], optima)
            if near is None:
                break
            x = balls(*in_c.displacement()) if in_c else self._in_balls(step, optimum)
            if x is None:
                near = None
                continue
            slacks, doubtful = far_slacks(step, np.flatnonzero(~near), x)
            if not doubtful.any():
                optimum = with_far(step, optimum, near, slacks)
                break
            near = _unless_all(near | doubtful)
        if self._may_be_long(both.si_form.g, optimum.delta_q):
            check_length(step, optimum.delta_q, group_steps(step))
        return optimum

    def _prover(self, both: StepInBothUnits) -> Prover | None:
        """What proves all groups of a step in C; None where nothing does."""
        if why_not() is None and self.prover is None:
            step = both.si_step
            groups = [
                (part.group, step if part.constant is None else part.constant, part.hessian(both))
                for part in self.parts
            ]
            self.prover = Prover(both, groups)
        return self.prover

    def _in_balls(self, step: StepData, optimum: ExactOptimum) -> Balls | None:
        """Balls about delta_q where the exact method has solved a group; None if not shown."""
        solved = list[Solved]()
        for part in self.parts:
            working = part.group.within(optimum.working_set)
            solved.append((part.group.coordinates, part.step(step), working))
        return displacement(step, solved)

    def _may_be_long(self, g: Array, delta_q: Array) -> bool:
        """Whether delta_q (n_v,) may be absurdly long in one of the groups; mostly it is not.

        Of three loads' steps the longest is at least a third of that of their sum, g (n_v,).
        """
        most = ILL_POSED / 4
        return not all(
            norm.of_displacement(delta_q[v]) <= most * norm.of_impulse(g[v])
            for v, norm in self.norms()
        )

    def _near(self, step: StepData, coupling: Coupling, lam: Array, slack: Array) -> Mask | None:
        """Which contacts may touch, as an answer says, shape (n_c,); None if all do.

        In small groups all do.
        """
        if step.n_v <= SMALL:
            return None
        self._groups(step, coupling)
        if self._small is None:
            return None
        m = int(step.offsets[-1])
        touching = (slack[:m] <= TOUCHING) | (lam[:m] > slack[:m])
        return _unless_all(self._small | np.logical_or.reduceat(touching, step.offsets[:-1]))

    def _groups(self, step: StepData, coupling: Coupling) -> list[Group]:
        """The groups of a step in which all contacts count."""
        if not unchanged(coupling, self._of_groups):
            self._found = groups(step)
            small = np.ones(step.contacts.n_c, dtype=bool)
            for group in self._found:
                small[group.contacts] = len(group.coordinates) <= SMALL
            self._small = _unless_all(small)
            self._of_groups = coupling
        return self._found

    def divided(self, step: StepData, near: Mask | None, coupling: Coupling) -> list[KeptGroup]:
        """The groups of a step: those of the last step, if the same couples its coordinates.

        Parameters
        ----------
        step : StepData
        near : ndarray of bool, shape (n_c,), or None
            The contacts that count; None if all do.
        coupling : list
            What couples the coordinates if all contacts count.
        """
        of = [*coupling, b"" if near is None else near.tobytes()]
        if not unchanged(of, self._of_parts):
            found = self._groups(step, coupling) if near is None else groups(step, near)
            self.parts = _parts(step, found, self.parts, whole=near is None)
            self._of_parts = of
            self.prover = None
        return self.parts


def _unless_all(mask: Mask) -> Mask | None:
    return None if mask.all() else mask


def coupled_by(step: StepData) -> Coupling:
    """What couples the coordinates of a step."""
    moving = step.contacts.moving()
    A = step.extra.A
    own = (A != 0).tobytes() if A.size else b""
    return [step.h, step.cone, step.K_q, step.kept_M_u, moving, own, step.row_layout.counts]


def unchanged(one: Coupling, two: Coupling) -> bool:
    """Whether two such lists are equal: mostly the same objects."""
    if len(one) != len(two):
        return False
    changed = [(a, b) for a, b in zip(one, two, strict=True) if a is not b]
    return all(np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b for a, b in changed)


def _parts(
    step: StepData, found: list[Group], before: list[KeptGroup], *, whole: bool
) -> list[KeptGroup]:
    """The groups of a step; those of equal constants share what is kept, also with the `before`.

    They are the `whole` step where all its contacts count.
    """
    if len(found) == 1 and whole:
        kept = before[0].kept if len(before) == 1 else Kept()
        return [KeptGroup(found[0], None, kept)]
    known = {part.key: part for part in before}
    parts = []
    for group in found:
        a, u = split(step, group)
        K_q = step.K_q[np.ix_(a, a)]
        M_u = step.inertia(u)
        counts = step.counts[group.contacts].tobytes()
        sizes = len(a), len(group.extra_rows)
        key = (step.h, step.cone, *sizes, K_q.tobytes(), M_u.tobytes(), counts)
        alike = known.get(key)
        if alike is None:
            rows = step.contacts.rows[group.contacts]
            constant = constants(step.h, K_q, len(a), M_u, rows, step.cone)
            known[key] = alike = KeptGroup(group, constant, Kept(), key)
        parts.append(KeptGroup(group, alike.constant, alike.kept, key))
    return parts
