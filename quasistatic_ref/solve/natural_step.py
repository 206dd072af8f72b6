"""A step in natural units: its program by groups, for a backend, a start and the judge."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from quasistatic_ref.certify.groups import Group, group_step
from quasistatic_ref.certify.norm import over_groups, single_lengths
from quasistatic_ref.certify.residuals import Residuals, optimality_residuals
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.solve.by_group import GroupIndex, GroupPrograms, NaturalHessian, layout_of
from quasistatic_ref.solve.units import (
    natural_units,
    out_of_range,
    sizes_of,
    squared_lengths,
)
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import (
    StandardForm,
    Units,
    clipped_gaps,
    linear_term,
    own_inequalities,
    row_constants,
)


class NaturalStep:
    """A step with its program, by groups, in natural units, in which it is guessed and judged.

    Parameters
    ----------
    step : StepData
    units : Units, optional
        Its natural units, where they are known.
    layout : GroupIndex, optional
        Of steps of its structure, where that is known; by default by the zeros of its numbers.
    known : ((ndarray, ndarray), ndarray), optional
        Its ``own_inequalities`` and g, where they are [m; N s, N m s].
    """

    def __init__(
        self,
        step: StepData,
        units: Units | None = None,
        layout: GroupIndex | None = None,
        known: tuple[tuple[Array, Array], Array] | None = None,
    ) -> None:
        self.step = step
        self._same_state: NaturalStep | None = None
        if units is not None:
            self.units = units
        if layout is not None:
            self.layout = layout
        if known is not None:
            self.own_inequalities, self.g = known

    @cached_property
    def layout(self) -> GroupIndex:
        """The groups of a backend's program."""
        return layout_of(self.step)

    @cached_property
    def own_inequalities(self) -> tuple[Array, Array]:
        """A of the contacts by their own columns, (m_c, w), and b of all rows, (m,) [m]."""
        return own_inequalities(self.step)

    @cached_property
    def g(self) -> Array:
        """The linear term of the step, (n_v,) [N s, N m s]."""
        return linear_term(self.step)

    @cached_property
    def squared_lengths(self) -> Array:
        """Squared lengths of the rows of A S, shape (m,) [m^2/(N m s)]."""
        H = self.layout.natural_hessian_of(self.step)
        squares = squared_lengths(self.own_inequalities[0], H.own_unit)
        extra = self.step.extra
        return np.append(squares, squared_lengths(extra.A, H.unit)) if extra.names else squares

    @cached_property
    def units(self) -> Units:
        """The natural units of the step.

        Raises
        ------
        StepDataError
            If products of its numbers leave the range of float64.
        """
        H = self.layout.natural_hessian_of(self.step)
        free_length = float(H.free_lengths(self.g))
        sizes = sizes_of(self.squared_lengths, self.own_inequalities[1], free_length)
        units = natural_units(H.unit, sizes)
        if not (0 < units.length < math.inf and 0 < units.size < math.inf):
            raise out_of_range()
        return units

    def with_loads(self, step: StepData) -> NaturalStep:
        """A step from the same place under other targets or loads: it differs in g alone."""
        other = NaturalStep(step, layout=self.layout)
        other.__dict__.update(
            own_inequalities=self.own_inequalities, squared_lengths=self.squared_lengths,
            _numeric_groups=self._numeric_groups, _same_state=self,
        )  # fmt: skip
        return other

    def with_gaps(self, step: StepData) -> NaturalStep:
        """A step that differs from this one in its gaps phi alone: A, g and H are as they are."""
        other = NaturalStep(step, layout=self.layout)
        A, b = self.own_inequalities
        gaps = -row_constants(step.contacts, step.cone)[step.mask]
        b = np.concatenate([gaps, b[len(gaps) :]])
        other.__dict__.update(own_inequalities=(A, b), g=self.g)
        return other

    def check_range(self) -> None:
        """Refuse a step that its natural units take out of the range of float64: StepDataError."""
        if not self.in_range:
            raise out_of_range()

    @cached_property
    def in_range(self) -> bool:
        """Whether all numbers of its programs are finite."""
        return self.programs.finite

    def write(self, programs: GroupPrograms) -> GroupPrograms:
        """Its programs, written over others of its layout; errors as of :meth:`check_range`."""
        H = self.layout.natural_hessian_of(self.step)
        written, self.in_range = self._written(self.layout, H, programs)
        self.check_range()
        return written if written.blocks is H.blocks else written._replace(blocks=H.blocks)

    @property
    def deepest(self) -> float:
        """The largest b of a row, and at least 0 [m]."""
        return float(self.own_inequalities[1].max(initial=0.0))

    @cached_property
    def form(self) -> StandardForm:
        """The standard form of the step: whole matrices."""
        n_v, m = self.step.n_v, self.step.m
        whole = StandardForm(np.zeros((n_v, n_v)), np.zeros(n_v), np.zeros((m, n_v)), np.zeros(m))
        for group, (H, g, A, b) in zip(self.layout.groups, self.programs.forms, strict=True):
            of_group = group.coordinates
            whole.H[np.ix_(of_group, of_group)] = H
            whole.g[of_group] = g
            whole.A[np.ix_(group.rows, of_group)] = A
            whole.b[group.rows] = b
        return whole

    @cached_property
    def programs(self) -> GroupPrograms:
        """The programs of the layout's groups, in natural units."""
        return self._programs(self.layout)

    def _programs(self, layout: GroupIndex) -> GroupPrograms:
        H = layout.natural_hessian_of(self.step)
        programs = layout.empty_programs(H)
        return self._written(layout, H, programs)[0]

    def _written(
        self, layout: GroupIndex, H: NaturalHessian, programs: GroupPrograms
    ) -> tuple[GroupPrograms, bool]:
        A, b = self.own_inequalities
        return layout.write(A, b, self.g, self.step.extra.A, self.units, H, programs)

    @cached_property
    def _numeric_groups(self) -> GroupIndex:
        """The layout of the groups that the step's numbers have: a structure's, but for zeros."""
        step = self.step
        whole = len(step.hessian.entries[0]) == self.layout.entries and step.contacts.moved_by_all
        return self.layout if whole and step.extra.empty else layout_of(step)

    @cached_property
    def groups(self) -> list[tuple[Group, StepData]]:
        """The groups of the step, each as a step of its own in SI units."""
        step = self.step
        if self._same_state is None:
            first, *others = self._numeric_groups.groups
            if not others:
                return [(first, step)]
            return [(group, group_step(step, group)) for group in (first, *others)]
        parts = []
        for group, part in self._same_state.groups:
            a = group.coordinates[: part.n_a]
            u = group.coordinates[part.n_a :] - step.n_a
            loads = {"tau_a": step.tau_a[a], "tau_u": step.tau_u[u]}
            change = step.delta_q_bar_a[a]
            whole = part is self._same_state.step
            parts.append(
                (group, step if whole else part.with_fields(**loads, delta_q_bar_a=change))
            )
        return parts

    @cached_property
    def forms(self) -> list[StandardForm]:
        """The standard form of each group in the natural units of the step."""
        finer = self._numeric_groups
        return (self.programs if finer is self.layout else self._programs(finer)).forms

    @cached_property
    def lengths(self) -> list[list[float]]:
        """Lengths of each group's unconstrained steps under single loads and all [(N m s)^0.5]."""
        return single_lengths(self.groups)

    @cached_property
    def ends(self) -> tuple[Array, Array]:
        """Gaps phi (n_c,) [m] and ends b of the user's rows [m, rad], within reach."""
        return clipped_gaps(self.step, self.units)

    @cached_property
    def out_of_reach(self) -> Mask:
        """Which rows are out of reach, and nearer in what solvers get: shape (m,)."""
        phi, b = self.ends
        beyond = np.repeat(phi < self.step.contacts.phi, self.step.counts)
        return np.concatenate([beyond, b > self.step.extra.b])

    @property
    def within_reach(self) -> StandardForm:
        """The standard form with every row within reach; StepDataError as of the range."""
        self.check_range()
        phi, b_extra = self.ends
        contacts = self.step.contacts.with_fields(phi=phi)
        b = -row_constants(contacts, self.step.cone)[self.step.mask]
        unit = self.units.size * self.units.length
        return self.form._replace(b=np.concatenate([b, b_extra]) / unit)

    @property
    def row_ratio(self) -> float:
        """Length of the longest row over that of the shortest, rows of zeros left out [-]."""
        squares = self.squared_lengths[self.squared_lengths != 0]
        return math.sqrt(squares.max() / squares.min()) if squares.size else 1.0

    def residuals(self, x: Array, lam: Array) -> Residuals:
        """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at x (n_v,), lam (m,) in natural units [-].

        The unit of size is at least the step that targets, tau_a or tau_u would cause alone: at
        rest they cancel but for rounding, and the size of the step is that of noise.
        """
        judges = [cone(part.cone).judge(part.contacts.mu) for _, part in self.groups]
        each = [
            optimality_residuals(form, x[group.coordinates], lam[group.rows], judge)
            for (group, _), form, judge in zip(self.groups, self.forms, judges, strict=True)
        ]
        worst = np.array([[*vars(residuals).values()] for residuals in each])
        residuals = Residuals(*worst.max(axis=0).tolist())
        if not self.step.n_v:
            return residuals
        length = max(over_groups(self.lengths)[:-1])
        size = self.units.size
        return residuals.in_size(length / size if size < length < math.inf else 1.0)
