"""Through CVXPY: the step as the paper's program (13)."""

import warnings
from time import perf_counter
from typing import Protocol

import cvxpy as cp
import numpy as np

from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.solve.backends import DEFAULT, Options
from quasistatic_ref.solve.cvxpy_problem import CvxpyProblem
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.solver import BackendSolver, NaturalAnswer, OptionSet
from quasistatic_ref.solve.units import DenseStepInBothUnits, StepInBothUnits, phi_within_reach
from quasistatic_ref.step.data import KIND, Array, Mask, StepData

CANON = cp.CPP_CANON_BACKEND
"""CVXPY's way of compiling, for problems of any size. From 1,000 parameters on it would choose
another by itself, which fails at a product of mu_v with J_1 delta_q (docs/studies.md)."""

MOST_CONTACTS = 2000
"""Most contacts that are compiled: 6 s, in a time that grows with their square."""


class CompiledProgram(Protocol):
    """A CVXPY problem whose answer can be read from it."""

    problem: cp.Problem

    def primal(self) -> Array:
        """The unknowns of the last solve, shape (n,), in the problem's units [-]."""

    def dual(self) -> Array | None:
        """Its multipliers, shape (m,), where the backend has any [-]."""


class CvxpySolver(BackendSolver):
    """The step's CVXPY problem, compiled once, and a backend that CVXPY has an interface to.

    Parameters
    ----------
    template : StepData
        A step of the kind that is to be solved.
    name : str
        Of the backend, without ``qpsolvers:``.
    """

    interface = "cvxpy"
    fixed = tuple(KIND)

    def __init__(self, template: StepData, name: str = DEFAULT) -> None:
        super().__init__(template, name)
        self.problem = CvxpyProblem(template)

    def answer(self, both: StepInBothUnits, accuracy: float) -> NaturalAnswer:
        """The backend's answer, unless CVXPY would compile the step for minutes: StepNotSolved."""
        if (n_c := both.si_step.contacts.n_c) > MOST_CONTACTS:
            status = (
                f"not called: CVXPY takes too long to compile {n_c} contacts, more than "
                f"{MOST_CONTACTS}; with fast = true it is not used"
            )
            raise StepNotSolved(self.name, status, both.si_step, accuracy)
        return super().answer(both, accuracy)

    def write(self, both: StepInBothUnits) -> Mask:
        """Fill the parameters; tell which rows are out of reach, shape (m,)."""
        assert isinstance(both, DenseStepInBothUnits)
        natural = both.natural_step
        near = phi_within_reach(natural)
        self.problem.fill(natural)
        self.problem.parameters["phi"].value = near
        return np.repeat(near < natural.contacts.phi, natural.counts)

    def reply(self, option_set: OptionSet, both: StepInBothUnits) -> Reply:
        """What the backend says, from a cold start.

        Cold, so that a step replayed by itself takes the same path. (PROXQP's interface in CVXPY
        raises TypeError on a second warm start anyway.)
        """
        return cvxpy_reply(self.problem, self.name, option_set.options, False)


def cvxpy_reply(compiled: CompiledProgram, name: str, options: Options, warm: bool) -> Reply:
    """The reply of a backend to a problem as its parameters stand.

    Parameters
    ----------
    compiled : CompiledProgram
    name : str
        Of the backend.
    options : dict
        In its own names.
    warm : bool
        Whether to start from the answer before.
    """
    problem = compiled.problem
    begin = perf_counter()
    with warnings.catch_warnings():
        # "Solution may be inaccurate" is dealt with below, by the status.
        warnings.filterwarnings("ignore", "Solution may be inaccurate", UserWarning)
        problem.solve(solver=name.upper(), warm_start=warm, canon_backend=CANON, **options)
    seconds = perf_counter() - begin
    status = str(problem.status)
    stats = problem.solver_stats
    own = None if stats.solve_time is None else float(stats.solve_time)
    known = all(x.value is not None for x in problem.variables() if x.size)
    return Reply(
        x=compiled.primal() if known else None,
        lam=compiled.dual() if known else None,
        solved=status == cp.OPTIMAL,
        status=status,
        iterations=None if stats.num_iters is None else int(stats.num_iters),
        seconds=own,
        call_seconds=seconds,
        own=own,
        setup=None if stats.setup_time is None else float(stats.setup_time),
    )
