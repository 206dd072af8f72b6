"""Solvers that keep what steps have in common."""

from quasistatic_ref.certify.norm import Norm
from quasistatic_ref.optional.between import FLOAT_BOUND, FloatBound
from quasistatic_ref.optional.fast.adapters.program import Program
from quasistatic_ref.optional.fast.backends import fast_backend
from quasistatic_ref.optional.fast.native import NativeSolver, native_backends
from quasistatic_ref.optional.fast.second_order import ConeSolver
from quasistatic_ref.optional.fast.sparse_solver import SparseSolver
from quasistatic_ref.solve.backends import RESIDUAL
from quasistatic_ref.solve.prover import Prover
from quasistatic_ref.solve.solver import FAST_SOLVER, Solver, solver_for
from quasistatic_ref.solve.units import DenseStepInBothUnits, StepInBothUnits, Units
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, Mask, StepData
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.tolerances import BOUNDED


def fast_solver(step: StepData, name: str | None = None) -> Solver:
    """A solver of steps like this one, by the backend's own interface where it has one.

    Any other backend is asked as without `fast`. Steps whose contacts are in blocks are handed over
    in sparse matrices.

    Parameters
    ----------
    step : StepData
    name : str, optional
        Of the backend.
    """
    name = fast_backend(name, step.cone)
    if name not in native_backends(step.cone):
        return solver_for(step, name)
    if cone(step.cone).curved is not None:
        return ConeSolver(step, name)
    if step.contacts.kept_columns is not None:
        return SparseSolver(step, name)
    return FastSolver(step, name)


class FastProver(Prover):
    """The exact method, with what H gives of norms and bounds kept while H stays.

    Attributes
    ----------
    bound : FloatBound or None
        For the H of the step whose error was bounded last.
    """

    def __init__(self) -> None:
        self.bound: FloatBound | None = None

    def norm(self, both: StepInBothUnits) -> Norm:
        """The norm ||.||_H of a step."""
        assert isinstance(both, DenseStepInBothUnits)
        return both.hessian.norm

    def error_bound(self, both: StepInBothUnits, delta_q: Array, lam: Array) -> float:
        """A bound of the relative error [-]: in float64, and in balls where that is open."""
        assert isinstance(both, DenseStepInBothUnits)
        H = both.hessian.natural_H
        if self.bound is None or self.bound.H is not H:
            self.bound = FLOAT_BOUND.needed(RESIDUAL)(H)
        error = self.bound.step_error(both, delta_q, lam)
        return error if error <= BOUNDED else super().error_bound(both, delta_q, lam)


class FastSolver(NativeSolver):
    """A backend's own interface, with what is kept while H stays.

    Parameters
    ----------
    template : StepData
        A step of the kind that is to be solved, in a polyhedral cone.
    name : str
        Of a backend with an adapter.

    Attributes
    ----------
    written : Units or None
        Natural units of the step whose g, A and b compiled code has written into the program.
    """

    prover: FastProver

    def __init__(self, template: StepData, name: str) -> None:
        super().__init__(template, name)
        self.prover = FastProver()
        self.written: Units | None = None

    def in_both_units(self, step: StepData) -> StepInBothUnits:
        """The step in both units; what H gives of them is kept while H is the same array."""
        return DenseStepInBothUnits(step, self.hessian)

    def write_program(self, both: StepInBothUnits) -> None:
        """Write the program in natural units, unless compiled code has."""
        if self.written is not both.units:
            super().write_program(both)
        self.written = None

    def write(self, both: StepInBothUnits) -> Mask | None:
        """Write the program, mostly the natural standard form; rows out of reach, shape (m,)."""
        assert isinstance(both, DenseStepInBothUnits)
        out_of_reach = super().write(both)
        p = self.program
        if out_of_reach is None and self.adapter.ORDER == "C" and isinstance(p, Program):
            both.natural_form = StandardForm(p.H, -p.f, p.A, p.b)  # until the next step
        return out_of_reach


FAST_SOLVER.fill(fast_solver)
