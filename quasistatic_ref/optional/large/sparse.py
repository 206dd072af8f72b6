"""Large steps: the sparse standard form handed to a backend's own interface.

As :mod:`~quasistatic_ref.solve.native`, in time and memory that grow with the number of entries
that are not zero. Answers are judged by residuals and a bound of the error
(:mod:`~quasistatic_ref.optional.large.sparse_bound`), or proved by `fast`, group by group.
"""

import math
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.norm import Norm
from quasistatic_ref.certify.optimality import Residuals, optimality_residuals
from quasistatic_ref.errors import BackendError
from quasistatic_ref.optional.large.sizes import sizes_of
from quasistatic_ref.optional.large.sparse_bound import LargeForm, SparseHessian, sparse_error_bound
from quasistatic_ref.optional.large.sparse_form import Pattern, sparse_form
from quasistatic_ref.solve.adapters.program import SparseProgram
from quasistatic_ref.solve.backends import BACKENDS, Options
from quasistatic_ref.solve.native import NativeSolver
from quasistatic_ref.solve.scaled import NaturalStep, check_units
from quasistatic_ref.solve.solver import NaturalAnswer, OptionSet
from quasistatic_ref.solve.units import coordinate_units, in_natural, small_power, units_from
from quasistatic_ref.step.data import Array, Mask, StepData
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.tolerances import FAR

GAPS = ("tol_gap_abs", "tol_gap_rel", "eps_duality_gap_abs", "eps_duality_gap_rel")
"""Options that ask for a duality gap: Clarabel's, then PIQP's."""


MOST_ITERATIONS = 100
"""Limit of the iterations of an interior-point method: one that has not reached its duality gap
after 40 mostly stalls, and is tried with other options sooner than after its usual 500."""


def reachable(options: Options, rows: int) -> Options:
    """Options whose duality gap can be reached, in fewer iterations; the same if they have no gap.

    The gap is a difference of sums over all rows, of terms near one in natural units: rounding
    leaves some 2^-52 of each. With a smaller gap Clarabel takes 20 to 30 more steps in search of a
    lucky one, and PIQP all that it may.
    """
    least = rows * float(np.finfo(np.float64).eps)
    gaps = {name: max(options[name], least) for name in GAPS if name in options}
    most = {"max_iter": min(options["max_iter"], MOST_ITERATIONS)} if gaps else {}
    return options | gaps | most


class SparseSolver(NativeSolver):
    """The pattern of large steps of one kind, and a backend that takes sparse matrices.

    Parameters
    ----------
    like : StepData
        With contacts in blocks, and no rows of the user's own.
    name : str
        Of a backend whose adapter takes sparse matrices.
    proofs : object
        What proves the optimum of a step that is certified exactly: the Proofs of `fast`.

    Raises
    ------
    BackendError
        If the backend takes no sparse matrices.
    StepDataError
        If the step is not in blocks.
    """

    def __init__(self, like: StepData, name: str, proofs: Any) -> None:
        able = [entry.name for entry in BACKENDS.values() if entry.sparse]
        if name not in able:
            problem = f"takes no sparse matrices; a step this large needs {', '.join(able)}"
            raise BackendError(problem, field="backend", value=name)
        self.proofs = proofs
        super().__init__(like, name)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.like, self.name, type(self.proofs)())

    def optimum(self, scaled: NaturalStep, answer: NaturalAnswer | None) -> ExactOptimum:
        """The exact optimum, proved group by group."""
        proved: ExactOptimum = self.proofs.optimum(scaled, answer)
        return proved

    def norm(self, scaled: NaturalStep) -> Norm:
        """The norm ||.||_H of a step."""
        norm: Norm = self.proofs.norm()
        return norm

    def empty(self) -> SparseProgram:
        """A program with H in natural units, which stays, and the pattern of A."""
        self.pattern = Pattern(self.like)
        P, A, column = self.pattern.P, self.pattern.A, self.pattern.P_column
        S = self.coordinate = coordinate_units(P.diagonal())
        scaled = csc_matrix((P.data * S[P.indices] * S[column], P.indices, P.indptr), P.shape)
        m, n = A.shape
        program = SparseProgram(scaled, np.zeros(n), A.copy(), np.zeros(m))
        self.of_H = SparseHessian(program.H)
        return program

    def takes(self, step: StepData) -> bool:
        """Whether a step has its entries where this pattern has them, and the same H."""
        return self.pattern.fits(step)

    def differences(self, step: StepData) -> list[str]:
        """In what a step is not like the one that the pattern was made for."""
        return [*super().differences(step), "H or the pattern of A"]

    def attempts(self, accuracy: float) -> list[OptionSet]:
        """The sets of options, none of which asks for a gap that rounding hides."""
        if accuracy not in self._attempts:
            for attempt in super().attempts(accuracy):
                attempt.options = reachable(attempt.options, len(self.program.b))
        return self._attempts[accuracy]

    def scaled(self, step: StepData) -> "SparseStep":
        """The step in natural units."""
        return SparseStep(step, self)

    def error_bound(self, scaled: NaturalStep, delta_q: Array, lam: Array) -> float:
        """A rigorous bound of the relative error [-] of delta_q (n_v,), lam (m,) in SI units."""
        assert isinstance(scaled, SparseStep)
        units = scaled.units
        sizes = sizes_of(scaled.step, units.coordinate, units.length, units.size)
        form = LargeForm(scaled.metric, scaled.g, scaled.A, scaled.b, sizes)
        return sparse_error_bound(form, *in_natural(delta_q, lam, units))

    def write(self, scaled: "SparseStep") -> Mask:
        """Write g, A and b; tell which rows are out of reach, shape (m,)."""
        program = self.program
        squares = np.bincount(scaled.A.indices, scaled.A.data**2, minlength=len(scaled.b))
        reach = -FAR * np.maximum(1.0, np.sqrt(squares))
        program.f[:] = -scaled.g
        program.A.data[:] = scaled.A.data
        np.maximum(scaled.b, reach, out=program.b)
        return np.asarray(scaled.b < reach)


class SparseStep:
    """A large step in its natural units.

    Parameters
    ----------
    step : StepData
        SI units.
    solver : SparseSolver
        Whose H it has.

    Raises
    ------
    StepDataError
        If products of its numbers leave the range of float64.
    """

    def __init__(self, step: StepData, solver: SparseSolver) -> None:
        self.step, self.H, self.metric = step, solver.program.H, solver.of_H
        form, S = sparse_form(step, solver.pattern), solver.coordinate
        rows = form.A.data * S[solver.pattern.column]
        squares = np.bincount(form.A.indices, rows * rows, minlength=len(form.b))
        y = form.g * S
        power = small_power(y)
        near_one = np.ldexp(y, -power)
        energy = math.sqrt(max(float(near_one @ solver.of_H.factor.solve(near_one)), 0.0))
        length = math.ldexp(energy, power)  # ||H^-1 g||_H
        self.units = units = units_from(S, np.sort(squares), length, form.b)
        check_units(units, step)
        self.A = csc_matrix((rows / units.length, form.A.indices, form.A.indptr), form.A.shape)
        self.g, self.b = y / units.size, form.b / (units.size * units.length)
        self.form: Any = form
        self.natural_form: Any = StandardForm(self.H, self.g, self.A, self.b)

    def residuals(self, delta_q: Array, lam: Array) -> Residuals:
        """Residuals of Eqs. :eq:`eq-9`-:eq:`eq-12` at delta_q (n_v,), lam (m,) in units [-]."""
        return optimality_residuals(self.natural_form, delta_q, lam)
