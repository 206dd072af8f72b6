"""Large steps: the sparse standard form handed to a backend's own interface.

As :mod:`~quasistatic_ref.optional.fast.native`, in time and memory that grow with the number of
entries that are not zero. Answers are judged by residuals and a bound of the error
(:mod:`~quasistatic_ref.optional.large.float_bound`), or proved group by group.
"""

from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum, step_optimum
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.errors import BackendError
from quasistatic_ref.optional.between import LARGE_STEPS, LargeSteps
from quasistatic_ref.optional.fast.adapters.program import SparseProgram
from quasistatic_ref.optional.fast.native import NativeSolver
from quasistatic_ref.solve.backends import BACKENDS, Options
from quasistatic_ref.solve.prover import Prover
from quasistatic_ref.solve.solver import NaturalAnswer, OptionSet
from quasistatic_ref.solve.units import StepInBothUnits
from quasistatic_ref.step.data import Array, Mask, StepData
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.tolerances import FAR

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix

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


class SparseProver(Prover):
    """The exact method for large steps, whose rows are sparse."""

    def __init__(self, kind: LargeSteps) -> None:
        self.kind = kind

    def optimum(self, both: StepInBothUnits, answer: NaturalAnswer | None) -> ExactOptimum:
        """The exact optimum."""
        if answer is None:
            return step_optimum(both.si_step)
        form = both.natural_form
        lam = answer.natural_lam
        slack = form.A @ answer.natural_delta_q - form.b
        pressed = np.flatnonzero(lam > np.maximum(slack, 0))
        A: csc_matrix = form.A
        rows = A.tocsr()[pressed].toarray()
        warm = warm_rows(rows, lam[pressed], slack[pressed])
        return step_optimum(both.si_step, pressed[warm].tolist())

    def error_bound(self, both: StepInBothUnits, delta_q: Array, lam: Array) -> float:
        """A rigorous bound of the relative error [-] of delta_q (n_v,), lam (m,) in SI units."""
        return self.kind.error_bound(both, delta_q, lam)


class SparseSolver(NativeSolver):
    """The pattern of large steps of one kind, and a backend that takes sparse matrices.

    Parameters
    ----------
    template : StepData
        With contacts in blocks, and no rows of the user's own.
    name : str
        Of a backend whose adapter takes sparse matrices.

    Raises
    ------
    BackendError
        If the backend takes no sparse matrices.
    StepDataError
        If the step is not in blocks.
    """

    prover: SparseProver

    def __init__(self, template: StepData, name: str) -> None:
        able = [entry.name for entry in BACKENDS.values() if entry.sparse]
        if name not in able:
            problem = f"takes no sparse matrices; a step this large needs {', '.join(able)}"
            raise BackendError(problem, field="backend", value=name)
        super().__init__(template, name)
        self.prover = SparseProver(self.kind)

    def empty(self) -> SparseProgram:
        """A program with H in natural units, which stays, and the pattern of A."""
        self.kind = LARGE_STEPS.needed("a step in blocks")(self.template)
        H, P, A = self.kind.matrices()
        m, n = A.shape
        return SparseProgram(H, P, np.zeros(n), A, np.zeros(m))

    def fits(self, step: StepData) -> bool:
        """Whether a step has its entries where this pattern has them, and the same H."""
        return self.kind.fits(step)

    def differences(self, step: StepData) -> list[str]:
        """In what a step is not like the one that the pattern was made for."""
        return [*super().differences(step), "H or the pattern of A"]

    def option_sets(self, accuracy: float) -> list[OptionSet]:
        """The sets of options, none of which asks for a gap that rounding hides."""
        if accuracy not in self._option_sets:
            for option_set in super().option_sets(accuracy):
                option_set.options = reachable(option_set.options, len(self.program.b))
        return self._option_sets[accuracy]

    def in_both_units(self, step: StepData) -> StepInBothUnits:
        """The step in SI units and in natural units."""
        return self.kind.in_both_units(step)

    def from_blocks(self, step: StepData, form: StandardForm) -> StepInBothUnits:
        """The same from the matrices of a step, of which A has the columns of its blocks."""
        return self.kind.from_blocks(step, form)

    def write(self, both: StepInBothUnits) -> Mask:
        """Write g, A and b; tell which rows are out of reach, shape (m,)."""
        program = self.program
        assert isinstance(program, SparseProgram)
        _, g, _, b = both.natural_form
        A: csc_matrix = both.natural_form.A
        squares = np.bincount(A.indices, A.data**2, minlength=len(b))
        reach = -FAR * np.maximum(1.0, np.sqrt(squares))
        program.f[:] = -g
        program.A.data[:] = A.data
        np.maximum(b, reach, out=program.b)
        return np.asarray(b < reach)
