r"""Natural units: the same problem in numbers near one.

Absolute tolerances of solvers mean nothing for a body of 0.1 kg that moves by 1e-6 m. With

.. math:: \delta q = \rho\,S\,x,\qquad \text{lengths in units of } \rho\,\ell

Eqs. :eq:`eq-13` and :eq:`eq-4` keep their form: S is diagonal, one unit per coordinate, such that
the diagonal of H becomes about one; ell is one length, such that the rows become about one; and
rho is the size of the step. The matrices do not depend on rho, because the problem is positively
homogeneous in (g, phi). With x dimensionless, rho S is in m or rad, rho ell in m and rho / ell in
N s; rho itself is in the unit of ||v||_H, (N m s)^0.5. All units are powers of two, so the
conversion loses nothing, unless a number leaves the range of float64.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import Group, group_step
from quasistatic_ref.certify.norm import energy_norm, over_groups, single_lengths
from quasistatic_ref.certify.residuals import Residuals, optimality_residuals
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.numbers.arrays import Array, Mask, all_finite
from quasistatic_ref.numbers.compiled import compiled
from quasistatic_ref.solve.by_group import (
    GroupLayout,
    NaturalHessian,
    Programs,
    coordinate_units,
    layout_of,
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
    standard_form,
)
from quasistatic_ref.tolerances import UNMOVED

SMALLEST = 2.0**-960
"""Least size of a step, over the largest of 1 and of the units of its coordinates: what is divided
by the size, times such a unit, is a float64."""


def squared_lengths(A: Array, unit: Array) -> Array:
    """Squared lengths of the rows of A S, shape (m,) [m^2/(N m s)], of any columns of A.

    Parameters
    ----------
    A : ndarray, shape (m, w)
        [m] per unit of delta_q.
    unit : ndarray, shape (w,) or (m, w)
        Of these columns, the diagonal of S [m or rad, per (N m s)^0.5].
    """
    if not A.shape[1]:
        return np.zeros(len(A))
    # Added in one order, so that columns of zeros change nothing.
    return np.asarray(np.add.accumulate(np.square(A * unit), axis=1)[:, -1])


def units_of(form: StandardForm) -> Units:
    """Natural units of any program; not finite where its numbers are not.

    Raises
    ------
    StepDataError
        As :func:`~quasistatic_ref.certify.norm.energy_norm`.
    """
    coordinate = coordinate_units(np.diag(form.H))
    free_length = energy_norm(form.H).of_impulse(form.g)
    sizes = sizes_of(squared_lengths(form.A, coordinate), form.b, free_length)
    return natural_units(coordinate, sizes)


class Sizes(NamedTuple):
    """How large a step is, by its rows and its load.

    Parameters
    ----------
    median : float
        Length of the rows of A S that are not zero; 1 if there are none [m per (N m s)^0.5].
    most : float
        Largest square of these lengths [m^2/(N m s)].
    push_out : float
        Largest entry of b, at least 0: of penetration [m].
    free_length : float
        ||H^-1 g||_H [(N m s)^0.5].
    """

    median: float
    most: float
    push_out: float
    free_length: float


def sizes_of(squares: Array, b: Array, free_length: float) -> Sizes:
    """The sizes from which natural units follow, from squared lengths of rows and b, (m,) each.

    `squares` (m,) are lengths of rows squared, `free_length` that of the free step [-].
    """
    median = _median_length(squares[squares != 0])
    return Sizes(median, float(squares.max(initial=0.0)), float(b.max(initial=0.0)), free_length)


@compiled
def step_sizes(A: Array, b: Array, g: Array, H: NaturalHessian) -> Sizes:
    """The sizes from which natural units follow, from rows by own columns, (m, w), b and g."""
    return sizes_of(squared_lengths(A, H.own_unit), b, float(H.free_lengths(g)))


def natural_units(coordinate: Array, sizes: Sizes) -> Units:
    """Natural units of a step; not finite where its numbers are not.

    Parameters
    ----------
    coordinate : ndarray, shape (n_v,)
        Diagonal of S [m or rad, per (N m s)^0.5].
    sizes : Sizes
    """
    length = _power_of_two(sizes.median)
    push_out = sizes.push_out / length
    if not math.isfinite(sizes.most):
        push_out = math.nan
    return Units(coordinate, length, natural_size(coordinate, sizes.free_length, push_out))


def natural_size(coordinate: Array, free_length: float, push_out: float) -> float:
    """The natural size rho of a step [(N m s)^0.5], NaN where its numbers are not finite.

    Parameters
    ----------
    coordinate : ndarray, shape (n_v,)
        Diagonal of S [m or rad, per (N m s)^0.5].
    free_length, push_out : float
        ||H^-1 g||_H, and the longest way out of a penetration [(N m s)^0.5].
    """
    size = max(free_length, push_out)
    softest = float(coordinate.max(initial=0.0))
    if size == 0:  # no load, no penetration: the optimum is zero
        size = UNMOVED / softest if coordinate.size else UNMOVED
    if not math.isfinite(free_length + push_out):
        return math.nan
    return _power_of_two(max(size, SMALLEST * max(1.0, softest)))


def natural_form(form: StandardForm, units: Units) -> StandardForm:
    """A standard form in natural units: H S S', g S / rho, A S / ell and b / (rho ell).

    Raises
    ------
    StepDataError
        If a number leaves the range of float64.
    """
    S, ell, rho = units
    H, g, A, b = form
    natural = StandardForm(H * np.outer(S, S), g * S / rho, A * (S / ell), b / (rho * ell))
    if not all(all_finite(array.ravel()) for array in natural):
        raise out_of_range()
    return natural


def in_si(delta_q: Array, lam: Array, units: Units) -> tuple[Array, Array]:
    """delta_q (n_v,) [m, rad] and lam (m,) [N s] in SI units from their values in natural units."""
    return delta_q * (units.size * units.coordinate), lam * (units.size / units.length)


def in_natural(delta_q: Array, lam: Array, units: Units) -> tuple[Array, Array]:
    """delta_q (n_v,) and lam (m,) in natural units [-] from their values in SI units."""
    return delta_q / (units.size * units.coordinate), lam / (units.size / units.length)


def _median_length(squares: Array) -> float:
    """The median of lengths, from their squares; 1 if there are none."""
    n = len(squares)
    if not n:
        return 1.0
    middle = [(n - 1) // 2, n // 2]
    low, high = np.partition(squares, middle)[middle].tolist()
    return (math.sqrt(low) + math.sqrt(high)) / 2


def _power_of_two(x: float) -> float:
    if not 0 < x < math.inf:
        return math.nan
    exponent = round(math.log2(x))
    return 2.0**exponent if exponent < 1024 else math.inf


class ScaledStep:
    """A step with its program, by groups, in SI units and in natural units, in which it is judged.

    Parameters
    ----------
    step : StepData
    units : Units, optional
        Its natural units, where they are known.
    layout : GroupLayout, optional
        Of steps of its structure, where that is known; by default by the zeros of its numbers.
    """

    def __init__(
        self, step: StepData, units: Units | None = None, layout: GroupLayout | None = None
    ) -> None:
        self.step = step
        self._place: ScaledStep | None = None
        if units is not None:
            self.units = units
        if layout is not None:
            self.layout = layout

    @cached_property
    def layout(self) -> GroupLayout:
        """The groups of a backend's program."""
        return layout_of(self.step)

    @cached_property
    def form(self) -> StandardForm:
        """The standard form of the step in SI units: whole matrices."""
        return standard_form(self.step)

    @cached_property
    def own_inequalities(self) -> tuple[Array, Array]:
        """A of the contacts by their own columns, (m_c, w), and b of all rows, (m,) [m]."""
        return own_inequalities(self.step)

    @cached_property
    def _g(self) -> Array:
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
        natural = self.layout.natural_hessian_of(self.step)
        A, b = self.own_inequalities
        if self.step.extra.names:
            free_length = float(natural.free_lengths(self._g))
            sizes = sizes_of(self.squared_lengths, b, free_length)
        else:
            sizes = step_sizes(A, b, self._g, natural)
        units = natural_units(natural.unit, sizes)
        if not (0 < units.length < math.inf and 0 < units.size < math.inf):
            raise out_of_range()
        return units

    def under(self, step: StepData) -> ScaledStep:
        """A step from the same place under other targets or loads: it differs in g alone."""
        other = ScaledStep(step, layout=self.layout)
        other.__dict__.update(
            own_inequalities=self.own_inequalities, squared_lengths=self.squared_lengths,
            _finer=self._finer, _place=self,
        )  # fmt: skip
        return other

    def check_range(self) -> None:
        """Refuse a step that its natural units take out of the range of float64: StepDataError."""
        if not self.programs.finite:
            raise out_of_range()

    @property
    def deepest(self) -> float:
        """The largest b of a row, and at least 0 [m]."""
        return float(self.own_inequalities[1].max(initial=0.0))

    @cached_property
    def natural(self) -> StandardForm:
        """The standard form of the step in natural units: whole matrices."""
        return natural_form(self.form, self.units)

    @cached_property
    def programs(self) -> Programs:
        """The programs of the layout's groups, in natural units."""
        return self._programs(self.layout)

    def _programs(self, layout: GroupLayout) -> Programs:
        return layout.programs(self.step, *self.own_inequalities, self._g, self.units)

    @cached_property
    def _finer(self) -> GroupLayout:
        """The layout of the groups that the step's numbers have: a structure's, but for zeros."""
        step = self.step
        whole = len(step.hessian.entries[0]) == self.layout.entries and step.contacts.moved_by_all
        return self.layout if whole and step.extra.empty else layout_of(step)

    @cached_property
    def groups(self) -> list[tuple[Group, StepData]]:
        """The groups of the step, each as a step of its own in SI units."""
        step = self.step
        if self._place is None:
            first, *others = self._finer.groups
            if not others:
                return [(first, step)]
            return [(group, group_step(step, group)) for group in (first, *others)]
        parts = []
        for group, part in self._place.groups:
            a = group.coordinates[: part.n_a]
            u = group.coordinates[part.n_a :] - step.n_a
            loads = {"tau_a": step.tau_a[a], "tau_u": step.tau_u[u]}
            change = step.delta_q_bar_a[a]
            whole = part is self._place.step
            parts.append(
                (group, step if whole else part.with_fields(**loads, delta_q_bar_a=change))
            )
        return parts

    @cached_property
    def natural_by_group(self) -> list[StandardForm]:
        """The standard form of each group in the natural units of the step."""
        finer = self._finer
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
    def near(self) -> StandardForm:
        """The standard form in natural units with every row within reach."""
        phi, b_extra = self.ends
        contacts = self.step.contacts.with_fields(phi=phi)
        b = -row_constants(contacts, self.step.cone)[self.step.mask]
        unit = self.units.size * self.units.length
        return self.natural._replace(b=np.concatenate([b, b_extra]) / unit)

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
            for (group, _), form, judge in zip(
                self.groups, self.natural_by_group, judges, strict=True
            )
        ]
        worst = np.array([[*vars(residuals).values()] for residuals in each])
        residuals = Residuals(*worst.max(axis=0).tolist())
        if not self.step.n_v:
            return residuals
        length = max(over_groups(self.lengths)[:-1])
        size = self.units.size
        return residuals.in_size(length / size if size < length < math.inf else 1.0)


def out_of_range() -> StepDataError:
    """The error for a step whose numbers are finite but whose natural units are not."""
    return StepDataError(
        "its numbers are too large, too small or too different: products of them exceed the "
        "range of float64; look for a wrong unit"
    )
