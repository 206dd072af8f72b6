"""Solvers that keep what steps have in common, and try a guessed working set before all else."""

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.certify.exact import ExactOptimum, exact_step, well_posed
from quasistatic_ref.certify.norm import EnergyNorm
from quasistatic_ref.optional.fast.backends import fast_backend
from quasistatic_ref.optional.fast.compiled import compiled
from quasistatic_ref.optional.fast.guess.confirm import BallHessian, BallStep
from quasistatic_ref.optional.fast.guess.exchange import proved_nearby
from quasistatic_ref.parts import needed_part, part
from quasistatic_ref.solve.backends import RESIDUAL
from quasistatic_ref.solve.native import NativeSolver, native_backends
from quasistatic_ref.solve.scaled import DenseStep, NaturalStep, check_units, out_of_range
from quasistatic_ref.solve.solver import Answer, Solver, solver_for, warm_start
from quasistatic_ref.solve.units import Metric, Units, in_natural, metric, units_of
from quasistatic_ref.step.cones import CurvedCone, cone
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import StandardForm, standard_form
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
    kind = cone(step.cone)
    if isinstance(kind, CurvedCone):
        return kind.native_solver(step, name)
    large = part("large.sparse_contacts")
    if large is not None and isinstance(step.contacts, large.SparseContacts):
        sparse: Solver = needed_part("large.sparse", "a step in blocks").SparseSolver(step, name)
        return sparse
    return FastSolver(step, name)


class FastSolver(NativeSolver):
    """A backend's own interface, with what is kept while H stays.

    Parameters
    ----------
    like : StepData
        A step of the kind that is to be solved, in a polyhedral cone.
    name : str
        Of a backend with an adapter.
    warm : bool
        Whether to start from the answer to the step before, where the backend can.

    Attributes
    ----------
    hessian : BallHessian or None
        Of the step that was certified last.
    prover : Prover or None
        Proofs in compiled code for steps of the same kind.
    bound : FloatBound or None
        Of the step whose error was bounded last.
    written : Units or None
        Natural units of the step whose g, A and b compiled code has written into the program.
    """

    def __init__(self, like: StepData, name: str, warm: bool = True) -> None:
        super().__init__(like, name, warm)
        self.hessian: BallHessian | None = None
        self.prover: Any = None
        self.bound: Any = None
        self.written: Units | None = None

    def scaled(self, step: StepData) -> NaturalStep:
        """The step in natural units; what H gives of them is kept while H is the same array."""
        return KeptStep(step, self.metric)

    def write_program(self, scaled: DenseStep) -> None:
        """Write the program in natural units, unless compiled code has."""
        if self.written is not scaled.units:
            super().write_program(scaled)
        self.written = None

    def write(self, scaled: DenseStep) -> NDArray[np.bool_] | None:
        """Write the program, mostly the natural standard form; rows out of reach, shape (m,)."""
        idle = super().write(scaled)
        p: Any = self.program
        if idle is None and self.adapter.ORDER == "C":
            scaled.natural_form = StandardForm(p.H, -p.f, p.A, p.b)  # until the next step
        return idle

    def kept_hessian(self, step: StepData) -> BallHessian:
        """H of a step in balls: the one that is kept, if it is the same.

        Raises
        ------
        StepDataError
            If H is not positive definite without rounding.
        """
        if self.hessian is None or not self.hessian.fits(step):
            self.hessian = BallHessian(step)
        return self.hessian

    def norm(self, scaled: DenseStep) -> EnergyNorm:
        """The norm ||.||_H of a step."""
        return self.kept_hessian(scaled.step).norm

    def optimum(self, scaled: DenseStep, answer: Answer | None) -> ExactOptimum:
        """The exact optimum: proved on a guess of its working set, or found by the exact method."""
        step, hessian = scaled.step, self.kept_hessian(scaled.step)
        found = None if answer is None else self._proved(scaled, answer, hessian)
        if found is None:
            warm = warm_start(scaled, answer)
            prove = BallStep(step, hessian).confirmed
            guess = np.array(warm, dtype=np.int64)
            found = proved_nearby(prove, guess, scaled.form, scaled.metric.inverse)
            if found is None:
                return exact_step(step, warm)
        return well_posed(step, found, hessian.norm, hessian.norm.impulse(scaled.form.g))

    def _proved(
        self, scaled: DenseStep, answer: Answer, hessian: BallHessian
    ) -> ExactOptimum | None:
        """The optimum proved on rows pressed in the answer: in C, or in balls; or None."""
        step, form = scaled.step, scaled.natural_form
        if np.count_nonzero(answer.lam) > step.n_v:  # rows that depend on each other
            return None
        in_c = compiled("certificate")
        if in_c is not None:
            self.prover = in_c.prover(step, scaled.units.coordinate, self.prover)
        slack = form.A.dot(answer.delta_q) - form.b
        (guess,) = (answer.lam > np.maximum(slack, 0)).nonzero()  # as warm_rows has it
        if self.prover is None:
            prove = BallStep(step, hessian).confirmed
        else:
            prove = partial(self.prover.optimum, step, units=scaled.units)
        return proved_nearby(prove, guess, scaled.form, scaled.metric.inverse)

    def error_bound(self, scaled: NaturalStep, delta_q: Array, lam: Array) -> float:
        """A bound of the relative error [-]: in float64, and in balls where that is open."""
        assert isinstance(scaled, DenseStep)
        form, (S, ell, rho) = scaled.natural_form, scaled.units
        hessian = self.kept_hessian(scaled.step)
        if self.bound is None or not self.bound.serves(hessian.inverse, S):
            bounds = needed_part("large.rounded_bound", RESIDUAL)
            self.bound = bounds.FloatBound(hessian.inverse, hessian.h, form.H, S)
        x, y = in_natural(delta_q, lam, scaled.units)
        error: float | None = self.bound.error(scaled.step, form, (ell, rho), x, y)
        if error is not None and error <= BOUNDED:
            return error
        return super().error_bound(scaled, delta_q, lam)


class KeptStep(DenseStep):
    """A step in natural units that takes over what is known of them.

    Parameters
    ----------
    step : StepData
    like : Metric or None
        Of an earlier step: taken over if H is the same array.
    form : StandardForm, optional
        That of the step, where it is known.
    units : Units, optional
        Its natural units, where they are known.
    """

    def __init__(
        self,
        step: StepData,
        like: Metric | None,
        form: StandardForm | None = None,
        units: Units | None = None,
    ) -> None:
        self.step = step
        self.form = standard_form(step) if form is None else form
        try:
            same = like is not None and like.H is self.form.H
            self.metric = like if like is not None and same else metric(self.form.H)
            self.units = units_of(self.form, self.metric) if units is None else units
        except np.linalg.LinAlgError:
            raise out_of_range(step) from None
        check_units(self.units, step, self.metric.usable)
