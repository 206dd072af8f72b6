"""Through CVXPY: the step as the paper's program (13)."""

from __future__ import annotations

import warnings
from time import perf_counter
from typing import Protocol

import cvxpy as cp
import cvxpy.settings as words

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.solve.backends import DEFAULT, Options
from quasistatic_ref.solve.interruptible import INTERRUPTIBLE
from quasistatic_ref.solve.solver import BackendSolver, Reply
from quasistatic_ref.solve.step_problem import CANON, StepProblem, is_large
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.data import KIND, StepData
from quasistatic_ref.step.problem import set_values

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
        self.problem = StepProblem(template)

    def answer(self, scaled: ScaledStep, accuracy: float) -> Reply:
        """The backend's answer, unless CVXPY would compile the step for minutes: StepNotSolved."""
        if (n_c := scaled.step.contacts.n_c) > MOST_CONTACTS:
            status = (
                f"not called: CVXPY takes too long to compile {n_c} contacts, more than "
                f"{MOST_CONTACTS}; with fast = true it is not used"
            )
            raise StepNotSolved(self.name, status, scaled.step, accuracy)
        return super().answer(scaled, accuracy)

    def write(self, scaled: ScaledStep) -> Mask:
        """Fill the parameters; tell which rows are out of reach, shape (m,)."""
        set_values(self.problem.page, scaled.step, scaled.units)
        return scaled.out_of_reach

    def reply(self, options: Options, scaled: ScaledStep) -> Reply:
        """What the backend says, from a cold start.

        Cold, so that a step replayed by itself takes the same path. (PROXQP's interface in CVXPY
        raises TypeError on a second warm start anyway.)
        """
        return cvxpy_reply(self.problem, self.name, options)


def cvxpy_reply(compiled: CompiledProgram, name: str, options: Options) -> Reply:
    """The reply of a backend to a problem as its parameters stand, from a cold start.

    Parameters
    ----------
    compiled : CompiledProgram
    name : str
        Of the backend.
    options : dict
        In its own names.
    """
    problem = compiled.problem
    begin = perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the status says so, too
        problem.solve(
            solver=INTERRUPTIBLE.get(name, name.upper()),
            warm_start=False,
            canon_backend=CANON,
            ignore_dpp=is_large(problem),
            **options,
        )
    seconds = perf_counter() - begin
    status = str(problem.status)
    known = status in words.SOLUTION_PRESENT
    said = problem.solver_stats
    return Reply(
        x=compiled.primal() if known else None,
        lam=compiled.dual() if known else None,
        solved=status == cp.OPTIMAL,
        status=status,
        iterations=None if said.num_iters is None else int(said.num_iters),
        seconds=None if said.solve_time is None else float(said.solve_time),
        call_seconds=seconds,
        setup=None if said.setup_time is None else float(said.setup_time),
    )
