"""Through CVXPY: the step as the paper's program (13)."""

from __future__ import annotations

from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, Protocol

import cvxpy as cp
import cvxpy.settings as words

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.solve.backends import DEFAULT, Options
from quasistatic_ref.solve.problem_data import ProblemData, is_large, problem_data, saved
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.solver import BackendSolver
from quasistatic_ref.solve.step_problem import StepProblem
from quasistatic_ref.solve.units import StepInBothUnits, within_reach
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import KIND, StepData

if TYPE_CHECKING:
    from quasistatic_ref.solve.compiled import ClarabelCall, CompiledMap

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
        self._compared = False

    def answer(self, both: StepInBothUnits, accuracy: float) -> Reply:
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
        near, out_of_reach = within_reach(both.natural_step)
        self.problem.set_parameters(near)
        return out_of_reach

    def reply(self, options: Options, both: StepInBothUnits) -> Reply:
        """What the backend says, from a cold start.

        Cold, so that a step replayed by itself takes the same path. (PROXQP's interface in CVXPY
        raises TypeError on a second warm start anyway.)
        """
        compiled, call = self._compiled
        direct = None
        if call is not None:
            try:
                direct = call.reply(options)
            except Exception:  # CVXPY's own call says what is wrong, if anything is
                self._compiled = compiled, None
        if direct is not None and self._compared:
            return direct
        data = None if compiled is None else compiled.data(options)
        reply = cvxpy_reply(self.problem, self.name, options, False, data)
        if direct is not None:  # the first one: each bit has to be CVXPY's
            self._compared = bits((direct.x, direct.lam)) == bits((reply.x, reply.lam))
            if not self._compared:
                self._compiled = compiled, None
        return reply

    @cached_property
    def _compiled(self) -> tuple[CompiledMap | None, ClarabelCall | None]:
        """The compiled map from parameters to data, and the call; the problem is filled.

        None where they do not serve, or where CVXPY has moved what is private to it.
        """
        page = self.problem
        if is_large(page.problem):
            return None, None
        template = problem_data(page.problem, self.name, {})
        try:
            from quasistatic_ref.solve.compiled import ClarabelCall, CompiledMap

            if not CompiledMap.serves(template):
                return None, None
            compiled = CompiledMap(page.problem, template)
            called = self.name == DEFAULT and cone(page.template.cone).polyhedral
            return compiled, ClarabelCall(page, compiled) if called else None
        except Exception:
            return None, None


def cvxpy_reply(
    compiled: CompiledProgram,
    name: str,
    options: Options,
    warm: bool,
    data: ProblemData | None = None,
) -> Reply:
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
    data : ProblemData, optional
        The problem's, where they are formed already.
    """
    problem = compiled.problem
    begin = perf_counter()
    data = problem_data(problem, name, options) if data is None else data
    solver_options = {key: value for key, value in options.items() if key != "verbose"}
    verbose = options.get("verbose", False)
    raw = data.chain.solve_via_data(problem, data.numbers, warm, verbose, solver_options)
    solution = data.chain.invert(raw, data.inverse)
    seconds = perf_counter() - begin
    status = str(solution.status)
    if status in words.ERROR:
        raise cp.error.SolverError(f"Solver '{name.upper()}' failed")
    known = status in words.SOLUTION_PRESENT
    if known:  # as `unpack_results` does, which evaluates the cost of it, too
        saved(problem, solution)
    solve_time = solution.attr.get(words.SOLVE_TIME)
    setup = solution.attr.get(words.SETUP_TIME)
    iterations = solution.attr.get(words.NUM_ITERS)
    solve_time = None if solve_time is None else float(solve_time)
    return Reply(
        x=compiled.primal() if known else None,
        lam=compiled.dual() if known else None,
        solved=status == cp.OPTIMAL,
        status=status,
        iterations=None if iterations is None else int(iterations),
        seconds=solve_time,
        call_seconds=seconds,
        setup=None if setup is None else float(setup),
    )
