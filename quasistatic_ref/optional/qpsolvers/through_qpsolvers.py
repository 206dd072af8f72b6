"""Through qpsolvers: the standard form handed over, without CVXPY."""

import warnings
from collections.abc import Callable
from time import perf_counter

import numpy as np
import qpsolvers

from quasistatic_ref.numbers.arrays import Mask
from quasistatic_ref.solve.backends import QPSOLVERS, Options
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.solver import BackendSolver, Reply, check_not_interrupted
from quasistatic_ref.step.standard_form import StandardForm


def available_solvers() -> list[str]:
    """Names of the solvers that qpsolvers finds here."""
    return list(qpsolvers.available_solvers)


class QpsolversSolver(BackendSolver):
    """A backend that qpsolvers knows; nothing is compiled, so it takes every step of its cone.

    Parameters
    ----------
    template : StepData
        A step in the cone of those that are to be solved.
    name : str
        Of the backend, with ``qpsolvers:``.
    """

    interface = "qpsolvers"
    fixed = ("cone",)

    def write(self, natural: NaturalStep) -> Mask:
        """Form H, g, A, b; tell which rows are out of reach, shape (m,)."""
        self.form = natural.within_reach
        return natural.out_of_reach

    def reply_with(self, options: Options, natural: NaturalStep) -> Reply:
        """The backend's reply, from a cold start."""
        name = self.name.removeprefix(QPSOLVERS)
        return qpsolvers_reply(self.form, name, options)


def qpsolvers_reply(form: StandardForm, name: str, options: Options, equations: int = 0) -> Reply:
    """The reply of a backend to a plain quadratic program.

    Parameters
    ----------
    form : StandardForm
    name : str
        Of the backend in qpsolvers.
    options : dict
        In its own names.
    equations : int
        How many of the first rows hold with equality.
    """
    H, g, A, b = form
    e = equations
    equal = {"A": A[:e].copy(), "b": b[:e].copy()} if e else {}
    program = qpsolvers.Problem(P=H.copy(), q=-g, G=-A[e:], h=-b[e:], **equal)
    begin = perf_counter()
    with warnings.catch_warnings():
        # It warns of dense matrices converted (13 x 80 numbers), of defaults that will change,
        # and of statuses, which are dealt with below.
        warnings.simplefilter("ignore")
        solution = qpsolvers.solve_problem(program, name, **options)
    seconds = perf_counter() - begin
    status, iterations = _status(solution)
    check_not_interrupted(status)
    solve_time, setup = _account(solution)
    z = solution.z
    if z is not None and e:
        z = np.append(-np.ravel(solution.y), z)  # Px + q + G'z + A'y = 0
    return Reply(
        None if solution.x is None else np.array(solution.x, dtype=np.float64),
        None if z is None else np.array(z, dtype=np.float64).reshape(-1),
        bool(solution.found),
        status,
        iterations,
        solve_time,
        seconds,
        setup,
    )


def _account(solution: qpsolvers.Solution) -> tuple[float | None, float | None]:
    """Seconds of solving and of setting up as the solver reports them, and not qpsolvers' clock."""
    extras = solution.extras or {}
    info = extras.get("info", extras)
    field: Callable[[str], float | None] = (
        info.get if isinstance(info, dict) else lambda name: getattr(info, name, None)
    )
    package = type(info).__module__
    unit = 1e-3 if "setup_time" in extras else 1e-6 if "proxsuite" in package else 1.0  # SCS: ms

    def seconds(name: str) -> float | None:
        time = field(name)
        return unit * float(time) if time is not None and time > 0 else None

    return seconds("solve_time"), seconds("setup_time")


def _status(solution: qpsolvers.Solution) -> tuple[str, int | None]:
    """What a backend called its result, and its iterations, where qpsolvers hands them on."""
    extras = solution.extras or {}
    info = extras.get("info")
    status = extras.get("status", getattr(info, "status", None))
    iterations = extras.get("iter", getattr(info, "iter", None))
    if "iterations" in extras:  # quadprog's: added, dropped
        iterations = np.ravel(extras["iterations"])[0]
    words = str(status) if status is not None else "found" if solution.found else "not found"
    return words.rpartition(".")[2], None if iterations is None else int(iterations)
