"""Large steps of one kind in natural units, and the sparse standard form of each.

As :mod:`~quasistatic_ref.solve.units`, in time and memory that grow with the number of
entries that are not zero. :class:`~quasistatic_ref.optional.fast.sparse_solver.SparseSolver`
hands them to a backend.
"""

import math

import numpy as np
from scipy.sparse import csc_matrix, triu

from quasistatic_ref.certify.residuals import Residuals, optimality_residuals
from quasistatic_ref.optional.between import LARGE_STEPS
from quasistatic_ref.optional.large.float_bound import FloatBound
from quasistatic_ref.optional.large.sizes import row_sizes, step_sizes
from quasistatic_ref.optional.large.sparse_form import Pattern, in_blocks, sparse_form
from quasistatic_ref.solve.units import (
    StepInBothUnits,
    check_units,
    coordinate_units,
    in_natural,
    small_power,
    units_from,
)
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import StandardForm


class LargeSteps:
    """What large steps of one kind have in common: H in natural units, and the pattern of A.

    Parameters
    ----------
    template : StepData
        A step of that kind, with contacts in blocks, and no rows of the user's own.

    Attributes
    ----------
    pattern : Pattern
    entry : ndarray of int
        Of the pattern.
    coordinate : ndarray, shape (n_v,)
        Diagonal of S [m or rad, per (N m s)^0.5].
    P : scipy.sparse.csc_matrix, shape (n_v, n_v)
        Upper triangle of H in natural units [-].
    bound : FloatBound
        Of errors; it has the whole of H.

    Raises
    ------
    StepDataError
        If the step is not in blocks.
    """

    def __init__(self, template: StepData) -> None:
        self.pattern = Pattern(template)
        H = self.pattern.H
        S = self.coordinate = coordinate_units(H.diagonal())
        natural = H.copy()
        natural.data *= S[H.indices] * np.repeat(S, np.diff(H.indptr))
        self.P = triu(natural, format="csc")
        self.bound = FloatBound(natural)
        self.entry = self.pattern.entry

    def matrices(self) -> tuple[csc_matrix, csc_matrix, csc_matrix]:
        """H in natural units, its upper triangle, and a matrix with the pattern of A."""
        return self.bound.H, self.P, self.pattern.A.copy()

    def fits(self, step: StepData) -> bool:
        """Whether a step has its entries where these have them, and the same H."""
        return self.pattern.fits(step)

    def in_both_units(self, step: StepData) -> "SparseStep":
        """A step of this kind in both units."""
        return SparseStep(step, self, sparse_form(step, self.pattern))

    def from_blocks(self, step: StepData, form: StandardForm) -> "SparseStep":
        """The same from the matrices of a step, of which A has the columns of its blocks."""
        A = self.pattern.matrix(form.A)
        return SparseStep(step, self, StandardForm(self.pattern.H, form.g, A, form.b))

    def error_bound(self, both: StepInBothUnits, delta_q: Array, lam: Array) -> float:
        """A rigorous bound of the relative error [-] of delta_q (n_v,), lam (m,) in SI units."""
        step = both.si_step
        units = both.units
        A = self.pattern.matrix(row_sizes(step, in_blocks(step).J))
        A.data *= (units.coordinate / units.length)[self.pattern.column]
        x, y = in_natural(delta_q, lam, units)
        return self.bound.error(both.natural_form, step_sizes(step, A, units), x, y)


class SparseStep:
    """A large step in SI and natural units.

    Parameters
    ----------
    step : StepData
        SI units.
    kind : LargeSteps
    form : StandardForm
        Sparse, in SI units.

    Raises
    ------
    StepDataError
        If products of its numbers leave the range of float64.
    """

    def __init__(self, step: StepData, kind: LargeSteps, form: StandardForm) -> None:
        self.si_step = step
        self.kind = kind
        S = kind.coordinate
        sparse: csc_matrix = form.A
        rows = sparse.data * S[kind.pattern.column]
        squares = np.bincount(sparse.indices, rows * rows, minlength=len(form.b))
        y = form.g * S
        power = small_power(y)
        near_one = np.ldexp(y, -power) if power else y
        square = max(float(near_one @ kind.bound.factor.solve(near_one)), 0.0)
        free_length = math.ldexp(math.sqrt(square), power)  # ||H^-1 g||_H
        self.units = units = units_from(S, np.sort(squares), free_length, form.b)
        check_units(units, step)
        self.si_form = form
        A = csc_matrix((rows / units.length, sparse.indices, sparse.indptr), sparse.shape)
        b = form.b / (units.size * units.length)
        self.natural_form = StandardForm(kind.bound.H, y / units.size, A, b)

    def natural_residuals(self, delta_q: Array, lam: Array) -> Residuals:
        """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at delta_q (n_v,), lam (m,) in units [-]."""
        return optimality_residuals(self.natural_form, delta_q, lam)


LARGE_STEPS.fill(LargeSteps)
