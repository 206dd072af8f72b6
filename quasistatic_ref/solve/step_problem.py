"""Any step in CVXPY: the paper's page, with any cone and rows of a user's, and a solver by it."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, Any, Protocol

import cvxpy as cp
import cvxpy.settings as words
import numpy as np

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.errors import BackendError, InputError, StepDataError, check_kind
from quasistatic_ref.numbers.arrays import Array, Mask, positive_number
from quasistatic_ref.solve.backends import (
    DEFAULT,
    NONE,
    QPSOLVERS,
    Options,
    backend,
    check_takes_cones,
    greeting_silenced,
    is_function,
)
from quasistatic_ref.solve.interruptible import INTERRUPTIBLE
from quasistatic_ref.solve.solver import BackendSolver, Reply
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.cones import PYRAMID, cone
from quasistatic_ref.step.data import KIND, StepData, check_step, differences
from quasistatic_ref.step.problem import paper_problem, set_values
from quasistatic_ref.tolerances import ACCURACY

if TYPE_CHECKING:
    from cvxpy.reductions.solvers.solving_chain import SolvingChain

CANON = cp.COO_CANON_BACKEND
"""CVXPY's way of compiling, for problems of any size: the step of ten boxes in a twentieth of the
time of the others, with the same data."""

MOST_ENTRIES = 60_000
"""Most entries of parameters whose map is compiled. With more, CVXPY forms the data of each step
anew, which takes less time than to compile them and to apply the map."""

MOST_CONTACTS = 2000
"""Most contacts that are compiled: 6 s, in a time that grows with their square."""

Additions = Callable[["StepProblem"], Sequence[cp.Constraint | cp.Expression]]
"""A user's constraints and scalar costs."""


class StepProblem:
    """Eq. :eq:`eq-13` in CVXPY, for all steps with the same h, mu_v, mu_omega, cone and size.

    ``problem`` is an ordinary :class:`cvxpy.Problem`, filled with a step in SI units: print it, or
    put another in its place, as below. Its costs are about 1e-7, below the tolerances of every
    solver: ``problem.solve()`` ends "optimal", and is wrong by up to all of its digits.
    :meth:`solve` solves it in natural units.

    Parameters
    ----------
    template : StepData
        A step of that kind, which fills it at first.
    additions : callable, optional
        A function of this problem that returns additional constraints and scalar costs. Where a
        cost replaces the springs, set K_q and tau_k to zero after each :meth:`fill`.

    Attributes
    ----------
    problem : cvxpy.Problem
    page : Page
        The paper's, with the parameters of the step's own rows and cost.
    parameters : dict of str to cvxpy.Parameter
        What changes from step to step, by name; :meth:`fill` sets it.
    delta_q, delta_q_a, delta_q_u : cvxpy.Expression
        The displacement [m, rad].
    contact_motion : tuple of cvxpy.Expression
        gap, slip_1, slip_2 and spin [m], shapes (n_c,), mu included in the last three.
    contact_rows : list of cvxpy.Constraint
        The rows of the cone: of the paper's, Eq. :eq:`eq-4` in its order, one constraint for that
        row of the contacts that have it; none where no contact has.
    extra : list of cvxpy.Constraint
        The rows of the step's own ``extra``: one constraint, or none.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> page = qr.StepProblem(step)
    >>> page.problem.is_qp()
    True
    >>> bool(abs(page.solve("clarabel") - qr.solve_step(step).delta_q).max() < 1e-12)
    True
    >>> import cvxpy
    >>> lift = page.delta_q[2] >= 1e-3  # [m]
    >>> page.problem = cvxpy.Problem(page.problem.objective, [*page.problem.constraints, lift])
    >>> round(float(page.solve()[2]), 12), page.problem.status
    (0.001, 'optimal')
    """

    def __init__(self, template: StepData, additions: Additions | None = None) -> None:
        check_step(template, "template")
        self.template = template
        page = paper_problem(template)
        self.page = page
        self.parameters = page.parameters
        self.delta_q_a = page.delta_q_a
        self.delta_q_u = page.delta_q_u
        self.delta_q = page.delta_q
        self.contact_motion = page.contact_motion
        self.contact_rows = page.contact_rows
        if template.cone != PYRAMID:  # the page's own
            kind = cone(template.cone)
            self.contact_rows = kind.constraints(self.contact_motion, template.mask)
        self.extra: list[cp.Constraint] = []
        if template.extra.names:
            A_extra = cp.Parameter(template.extra.A.shape, "A_extra")
            b_extra = cp.Parameter(template.extra.b.shape, "b_extra")
            self.parameters |= {"A_extra": A_extra, "b_extra": b_extra}
            self.extra = [A_extra @ self.delta_q >= b_extra]
        objective = page.problem.objective
        if template.extra.cost is not None:
            H_extra = cp.Parameter((template.n_v, template.n_v), "H_extra", PSD=True)
            g_extra = cp.Parameter(template.n_v, "g_extra")
            self.parameters |= {"H_extra": H_extra, "g_extra": g_extra}
            quadratic = cp.quad_form(self.delta_q, H_extra) / 2
            objective += cp.Minimize(quadratic - g_extra @ self.delta_q)
        constraints = [*self.contact_rows, *self.extra]
        for term in [] if additions is None else additions(self):
            if isinstance(term, cp.Constraint):
                constraints.append(term)
            else:
                objective += cp.Minimize(term)
        self.problem = cp.Problem(objective, constraints)
        self.fill(template)

    def __repr__(self) -> str:
        step = self.template
        size = f"{step.n_v} unknowns, {step.m} rows"
        return f"<{type(self).__name__} of {size}: h = {step.h:g} s, cone {step.cone}>"

    def fill(self, step: StepData) -> None:
        """Set every parameter from one step, in SI units.

        Raises
        ------
        StepDataError
            If the step is of another kind, naming what differs.
        """
        check_step(step)
        for name in differences(self.template, step):
            needed = np.asarray(KIND[name](self.template)).tolist()
            value = np.asarray(KIND[name](step)).tolist()
            message = f"must be {needed!r}; make a problem of this step"
            raise StepDataError(message, field=name, value=value)
        self.step = step
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows has no answer
            set_values(self.page, step)

    def solve(self, solver: str = "clarabel", accuracy: float = ACCURACY) -> Array:
        """A solver's answer to ``problem`` as it stands, found in natural units.

        It is the solver's own: nothing is proved. The problem then has its status and value, the
        variables and the multipliers of all constraints, in SI units.

        Parameters
        ----------
        solver : str
            A backend that CVXPY calls; upper case, as in CVXPY, is as good.
        accuracy : float
            Of the answer, in natural units [-].

        Returns
        -------
        ndarray, shape (n_v,)
            delta_q [m, rad].

        Raises
        ------
        BackendError
            If the solver is unknown or not installed, or not one that CVXPY calls, or does not take
            the problem's cones.
        InputError
            If an unknown of the problem is a whole number.
        StepNotSolved
            If it claims anything but a full solution.
        """
        # Here: it has names of CVXPY that a new one may move.
        from quasistatic_ref.solve.scaled import solve_scaled

        check_kind(solver, str, "solver", "the name of a backend")
        accuracy = positive_number(accuracy, "accuracy")
        name = solver.lower()
        if name == NONE or name.startswith(QPSOLVERS) or is_function(name):
            raise BackendError("is not called through CVXPY", field="backend", value=solver)
        if self.problem.is_mixed_integer():
            problem = "has unknowns that are whole numbers: call problem.solve(), which sees metres"
            raise InputError(problem, field="StepProblem")
        entry = backend(name)
        if name == "highs":
            greeting_silenced()
        if not self.problem.is_qp():
            check_takes_cones(name, "this problem")
        attempts = entry.attempts(accuracy, not self.problem.is_qp())
        for _, options in attempts:
            try:
                data = problem_data(self.problem, name, options)
                solve_scaled(self.problem, data, options)
            except (InputError, cp.error.DCPError):
                raise
            except Exception as error:  # whatever another package raises
                status = f"the solver failed: {error}"
                continue
            status = str(self.problem.status)
            if status == cp.OPTIMAL:
                return self.primal()
        raise StepNotSolved(name, status, self.step, attempts[-1][0])

    def primal(self) -> Array:
        """delta_q of the last solve, shape (n_v,)."""
        return np.concatenate([x.value for x in (self.delta_q_a, self.delta_q_u) if x.size])

    def dual(self) -> Array | None:
        """Multipliers of the last solve, contact-major, the user's own rows last; shape (m,).

        None if its solver gave none, as SCIP does, or HiGHS where an unknown is a whole number.
        CVXPY would keep those of the solve before.
        """
        solution = self.problem.solution
        rows = [*self.contact_rows, *self.extra]
        if solution is None or any(row.id not in solution.dual_vars for row in rows):
            return None
        template = self.template
        mu = template.contacts.mu
        lam = cone(template.cone).multipliers(self.contact_rows, template.mask, mu)
        return np.concatenate([lam, *(row.dual_value for row in self.extra)])


@dataclass(frozen=True, eq=False)
class ProblemData:
    """A compiled CVXPY problem: what ``cvxpy.Problem.get_problem_data`` returns.

    Parameters
    ----------
    numbers : dict
        The data of the solver: P, c, A, b and the cones, by CVXPY's words.
    chain : SolvingChain
        Has ``solve_via_data``.
    inverse : list
        What ``unpack_results`` leads back to the problem with.
    """

    numbers: dict[str, Any]
    chain: SolvingChain
    inverse: list[Any]


def problem_data(problem: cp.Problem, name: str, options: Options) -> ProblemData:
    """The data as CVXPY forms them, for any backend.

    The first call compiles the problem, unless its parameters are many: their values then count as
    constants, in each call.
    """
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        data = problem.get_problem_data(
            INTERRUPTIBLE.get(name, name.upper()),
            ignore_dpp=is_large(problem),
            canon_backend=CANON,
            solver_opts=options,
        )
    if any("not DPP" in str(one.message) for one in warned):
        words = f"{name} takes no quadratic cost: CVXPY compiles each step anew, which takes longer"
        warnings.warn(words, stacklevel=2)
    return ProblemData(*data)


def is_large(problem: cp.Problem) -> bool:
    """Whether a problem has more entries of parameters than are compiled."""
    return bool(sum([parameter.size for parameter in problem.parameters()]) > MOST_ENTRIES)


class CompiledProgram(Protocol):
    """A CVXPY problem whose answer can be read from it."""

    problem: cp.Problem

    def primal(self) -> Array:
        """The unknowns of the last solve, shape (n,), in the problem's units [-]."""

    def dual(self) -> Array | None:
        """Multipliers of the last solve, shape (m,) [-]; None if the backend has none."""


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
