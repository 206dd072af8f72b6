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

import math
from functools import cached_property

import numpy as np

from quasistatic_ref.certify.curved_cone import judge_of
from quasistatic_ref.certify.groups import Group, group_steps
from quasistatic_ref.certify.norm import energy_norm, joined, single_lengths
from quasistatic_ref.certify.residuals import Residuals, optimality_residuals
from quasistatic_ref.errors import StepDataError
from quasistatic_ref.numbers.arrays import Array, Mask, all_finite
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import row_constants
from quasistatic_ref.step.standard_form import StandardForm, standard_form
from quasistatic_ref.step.units import Units, ends_within
from quasistatic_ref.tolerances import UNMOVED

SMALLEST = 2.0**-960
"""Least size of a step, over the largest of 1 and of the units of its coordinates: what is divided
by the size, times such a unit, is a float64."""


def coordinate_units(diagonal: Array) -> Array:
    """Diagonal of S, shape (n_v,) [m or rad, per (N m s)^0.5], from the `diagonal` of H."""
    return powers_of_two(1 / np.sqrt(diagonal))


def powers_of_two(x: Array | float) -> Array:
    """The power of two next to each of positive numbers, in their shape."""
    return np.exp2(np.round(np.log2(x)))


def squared_lengths(A: Array, coordinate: Array) -> Array:
    """Squared lengths of the rows of A S that are not zero [m^2/(N m s)], ascending: (k,), k <= m.

    Parameters
    ----------
    A : ndarray, shape (m, n_v)
        [m] per unit of delta_q.
    coordinate : ndarray, shape (n_v,)
        Diagonal of S [m or rad, per (N m s)^0.5].
    """
    # Squares and sums are rounded, which is enough to choose a power of two.
    squares: Array = np.square(A).dot(np.square(coordinate))
    return np.sort(squares[squares != 0])  # NaN comes last


def units_of(form: StandardForm) -> Units:
    """Natural units of a step from its standard form; not finite where its numbers are not.

    In C: natural.c.

    Raises
    ------
    StepDataError
        As :func:`~quasistatic_ref.certify.norm.energy_norm`.
    """
    coordinate = coordinate_units(np.diag(form.H))
    squares = squared_lengths(form.A, coordinate)
    free_length = energy_norm(form.H).of_impulse(form.g)  # ||H^-1 g||_H
    length = _power_of_two(_median_length(squares))
    push_out = float(form.b.max(initial=0.0)) / length  # from penetration
    size = max(free_length, push_out)
    softest = float(coordinate.max(initial=0.0))
    if size == 0:  # no load, no penetration: the optimum is zero
        size = UNMOVED / softest if coordinate.size else UNMOVED
    if not math.isfinite(free_length + push_out + squares.max(initial=0.0)):
        size = math.nan
    size = _power_of_two(max(size, SMALLEST * max(1.0, softest)))
    return Units(coordinate, length, size)


def natural_step(step: StepData, units: Units) -> StepData:
    """A step in natural units; h, n, d1, d2, mu_v and mu_omega stay as they are.

    Raises
    ------
    StepDataError
        If a number leaves the range of float64.
    """
    S = units.coordinate
    ell = units.length
    rho = units.size
    S_a = S[: step.n_a]
    S_u = S[step.n_a :]
    c = step.contacts
    extra = step.extra
    of_step = {
        "K_q": step.K_q * np.outer(S_a, S_a),
        "M_u": step.M_u * np.outer(S_u, S_u),
        "tau_a": step.tau_a * S_a / rho,
        "tau_u": step.tau_u * S_u / rho,
        "delta_q_bar_a": step.delta_q_bar_a / (rho * S_a),
    }
    of_contacts = {"phi": c.phi / (rho * ell), "J": c.J * (S / ell)}
    of_extra = {"A": extra.A * (S / ell), "b": extra.b / (rho * ell)}
    if extra.cost is not None:
        of_extra |= {"H": extra.cost[0] * np.outer(S, S), "g": extra.cost[1] * S / rho}
    arrays = [*of_step.values(), *of_contacts.values(), *of_extra.values()]
    for array in arrays:
        array.setflags(write=False)
    if not all_finite(np.concatenate([array.ravel() for array in arrays])):
        raise out_of_range()
    # Shapes, signs, frames and definiteness are those of the step, which are checked.
    if not extra.empty:
        extra = extra.with_fields(**of_extra)
    return step.with_fields(**of_step, contacts=c.with_fields(**of_contacts), extra=extra)


def in_si(delta_q: Array, lam: Array, units: Units) -> tuple[Array, Array]:
    """delta_q (n_v,) [m, rad] and lam (m,) [N s] in SI units from their values in natural units."""
    return delta_q * (units.size * units.coordinate), lam * (units.size / units.length)


def in_natural(delta_q: Array, lam: Array, units: Units) -> tuple[Array, Array]:
    """delta_q (n_v,) and lam (m,) in natural units [-] from their values in SI units."""
    return delta_q / (units.size * units.coordinate), lam / (units.size / units.length)


def _median_length(squares: Array) -> float:
    """The median of lengths, from their squares in ascending order; 1 if there are none."""
    n = len(squares)
    return (math.sqrt(squares[(n - 1) // 2]) + math.sqrt(squares[n // 2])) / 2 if n else 1.0


def _power_of_two(x: float) -> float:
    if not 0 < x < math.inf:
        return math.nan
    exponent = round(math.log2(x))
    return 2.0**exponent if exponent < 1024 else math.inf


def of_group(form: StandardForm, group: Group) -> StandardForm:
    """Those matrices of a program that are of one group."""
    c = group.coordinates
    if len(c) == len(form.g) and len(group.rows) == len(form.b):
        return form
    block = form.H[np.ix_(c, c)]
    return StandardForm(block, form.g[c], form.A[np.ix_(group.rows, c)], form.b[group.rows])


class StepInBothUnits:
    """A step with its standard form, in SI units and in natural units, in which it is judged.

    Parameters
    ----------
    si_step : StepData
    """

    def __init__(self, si_step: StepData) -> None:
        self.si_step = si_step

    @cached_property
    def si_form(self) -> StandardForm:
        """Its standard form in SI units."""
        return standard_form(self.si_step)

    @cached_property
    def units(self) -> Units:
        """Its natural units.

        Raises
        ------
        StepDataError
            If products of its numbers leave the range of float64.
        """
        units = units_of(self.si_form)
        if not (0 < units.length < math.inf and 0 < units.size < math.inf):
            raise out_of_range()
        return units

    @cached_property
    def natural_step(self) -> StepData:
        """The step in its natural units."""
        return natural_step(self.si_step, self.units)

    @cached_property
    def natural_form(self) -> StandardForm:
        """Its standard form in natural units."""
        return standard_form(self.natural_step)

    @cached_property
    def parts(self) -> list[tuple[Group, StepData]]:
        """Its groups, each as a step in SI units."""
        return group_steps(self.si_step)

    @cached_property
    def lengths(self) -> list[list[float]]:
        """Of each group, those of :func:`~quasistatic_ref.certify.norm.single_lengths`."""
        return single_lengths(self.parts)

    @cached_property
    def natural_forms(self) -> list[StandardForm]:
        """The standard form of each group in the natural units of the step."""
        form = self.natural_form
        return [of_group(form, group) for group, _ in self.parts]

    @cached_property
    def ends(self) -> tuple[Array, Array]:
        """Phi (n_c,) and b of a user's rows within reach: natural units [-]."""
        return ends_within(self.si_step, self.units)

    @cached_property
    def out_of_reach(self) -> Mask:
        """Which rows are out of reach, and nearer in what solvers get: shape (m,)."""
        step = self.si_step
        phi, b = self.ends
        unit = self.units.size * self.units.length
        beyond = np.repeat(phi < step.contacts.phi / unit, step.counts)
        return np.concatenate([beyond, b > step.extra.b / unit])

    @property
    def near_form(self) -> StandardForm:
        """The standard form in natural units with every row within reach."""
        phi, b_extra = self.ends
        contacts = self.si_step.contacts.with_fields(phi=phi)
        b = -row_constants(contacts, self.si_step.cone)[self.si_step.mask]
        return self.natural_form._replace(b=np.concatenate([b, b_extra]))

    @property
    def row_ratio(self) -> float:
        """Length of the longest row over that of the shortest, rows of zeros left out [-]."""
        squares = squared_lengths(self.si_form.A, self.units.coordinate)
        return math.sqrt(squares[-1] / squares[0]) if squares.size else 1.0

    def natural_residuals(self, delta_q: Array, lam: Array) -> Residuals:
        """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at delta_q (n_v,), lam (m,) in units [-].

        The unit of size is at least the step that targets, tau_a or tau_u would cause alone: at
        rest they cancel but for rounding, and the size of the step is that of noise.
        """
        each = [
            optimality_residuals(
                form,
                delta_q[group.coordinates],
                lam[group.rows],
                judge_of(part),
            )
            for (group, part), form in zip(self.parts, self.natural_forms, strict=True)
        ]
        worst = np.array([[*vars(residuals).values()] for residuals in each])
        residuals = Residuals(*worst.max(axis=0).tolist())
        if not self.si_step.n_v:
            return residuals
        length = max(joined(self.lengths)[:-1])
        size = self.units.size
        return residuals.in_size(length / size if size < length < math.inf else 1.0)


def out_of_range() -> StepDataError:
    """The error about a step whose numbers are finite, but not what is made of them."""
    return StepDataError(
        "its numbers are too large, too small or too different: products of them exceed the "
        "range of float64; look for a wrong unit"
    )
