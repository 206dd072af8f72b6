"""Any step in CVXPY: the paper's page, with any cone and rows of a user's, and a solver by it."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from time import perf_counter
from typing import Any, Protocol

import cvxpy as cp
import cvxpy.settings as words
import numpy as np

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.errors import (
    BackendError,
    InputError,
    StepDataError,
    check_kind,
    keywords_named,
)
from quasistatic_ref.numbers.arrays import Array, Mask, positive_number
from quasistatic_ref.solve.backends import (
    DEFAULT,
    NONE,
    QPSOLVERS,
    Options,
    bare,
    check_takes_cones,
    greeting_silenced,
    is_function,
)
from quasistatic_ref.solve.backends import (
    backend as entry_of,
)
from quasistatic_ref.solve.interruptible import INTERRUPTIBLE
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.problem_copies import give_solution, uncompiled, unknown_additions
from quasistatic_ref.solve.solver import BackendSolver, Reply
from quasistatic_ref.solve.units import in_si
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import KIND, StepData, check_step, differences
from quasistatic_ref.step.problem import paper_problem, set_values
from quasistatic_ref.step.standard_form import Units, page_units, si_units
from quasistatic_ref.tolerances import ACCURACY

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

    ``problem`` is an ordinary :class:`cvxpy.Problem` in accelerations and forces, filled with a
    step in SI units: print it, solve it by its own ``solve``, put its parts into another. Solved so
    by Clarabel as it comes, the steps of the scenarios have 10 correct digits in the median, and 5
    at least. Digits are lost where numbers are small: bodies of a millionth of these masses and
    springs have 2 to 5 (by PIQP 1 to 4, by OSQP 0 or 1), and what rests has none that counts, since
    its true displacement is zero. ``problem.solve(solver=qr.Exact())`` answers exactly, terms of
    one's own included; :meth:`solve` solves the problem in natural units.

    Parameters
    ----------
    template : StepData
        A step of that kind, which fills it at first.
    additions : callable, optional
        A function of this problem that returns additional constraints [m, rad] and scalar costs
        [N m s] of ``delta_q``; they enter as :meth:`row` and :meth:`cost` divide them. Where a cost
        replaces the springs, set K_q and tau_k to zero after each :meth:`fill`.

    Attributes
    ----------
    problem : cvxpy.Problem
    page : Page
        The paper's, with the parameters of the step's own rows and cost.
    parameters : dict of str to cvxpy.Parameter
        What changes from step to step, by name; :meth:`fill` sets it, from a step whose K_q and M_u
        are checked. An assignment to their ``value`` is not checked.
    a_a, a_u : cvxpy.Variable
        The unknowns: accelerations [m/s^2, rad/s^2].
    delta_q, delta_q_a, delta_q_u : cvxpy.Expression
        The displacement, h^2 times as much [m, rad].
    contact_motion : tuple of cvxpy.Expression
        gap, slip_1, slip_2 and spin [m], shapes (n_c,), mu included in the last three.
    contact_rows : list of cvxpy.Constraint
        The rows of the cone: of the paper's, Eq. :eq:`eq-4` over h^2 in its order, one constraint
        for that row of the contacts that have it; none where no contact has. The ``dual_value`` of
        each is a force [N], lam / h.
    extra : list of cvxpy.Constraint
        The rows of the step's own ``extra``, over h^2: one constraint, or none.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> page = qr.StepProblem(step)
    >>> page.problem.is_qp()
    True
    >>> _ = page.problem.solve(solver="CLARABEL")
    >>> bool(abs(page.delta_q.value - qr.solve_step(step).delta_q).max() < 1e-12)
    True
    >>> forces = [row.dual_value.sum() for row in page.contact_rows]  # [N]
    >>> round(float(sum(forces)), 6)  # the normal force, m g
    2.943

    With a row of one's own, here a lift of at least 1 mm, whose multiplier is a force, too:

    >>> import cvxpy
    >>> lift = page.row(page.delta_q[2] >= 1e-3)
    >>> lifted = cvxpy.Problem(page.problem.objective, [*page.problem.constraints, lift])
    >>> _ = lifted.solve(solver="CLARABEL")
    >>> round(float(page.delta_q.value[2]), 9), round(float(lift.dual_value), 6)  # m g + m z / h^2
    (0.001, 5.943)
    """

    @keywords_named
    def __init__(self, template: StepData, additions: Additions | None = None) -> None:
        check_step(template, "template")
        self.template = template
        page = paper_problem(template)
        self.page = page
        self.parameters = page.parameters
        self.a_a = page.a_a
        self.a_u = page.a_u
        self.delta_q_a = page.delta_q_a
        self.delta_q_u = page.delta_q_u
        self.delta_q = page.delta_q
        self.contact_motion = page.contact_motion
        self.contact_rows = page.contact_rows
        self.extra: list[cp.Constraint] = []
        if template.extra.names:
            A_extra = cp.Parameter(template.extra.A.shape, "A_extra")
            b_extra = cp.Parameter(template.extra.b.shape, "b_extra")
            self.parameters |= {"A_extra": A_extra, "b_extra": b_extra}
            self.extra = [self.row(A_extra @ self.delta_q - b_extra)]
        objective = page.problem.objective
        if template.extra.cost is not None:
            H_extra = cp.Parameter((template.n_v, template.n_v), "H_extra")
            g_extra = cp.Parameter(template.n_v, "g_extra")
            self.parameters |= {"H_extra": H_extra, "g_extra": g_extra}
            a = self.delta_q / template.h**2
            quadratic = template.h / 2 * cp.quad_form(a, H_extra, assume_PSD=True)
            objective += cp.Minimize(quadratic + self.cost(-g_extra @ self.delta_q))
        constraints = [*self.contact_rows, *self.extra]
        for term in [] if additions is None else additions(self):
            if isinstance(term, cp.Constraint):
                constraints.append(self.row(term))
            else:
                objective += cp.Minimize(self.cost(term))
        self.problem = cp.Problem(objective, constraints)
        self._posed = self.problem
        self._additions = additions
        self.fill(template)

    def __getstate__(self) -> dict[str, Any]:
        """Without what CVXPY compiled of the problems, which no pickle or copy can hold."""
        posed = uncompiled(self._posed)
        problem = posed if self.problem is self._posed else uncompiled(self.problem)
        page = replace(self.page, problem=uncompiled(self.page.problem))
        additions = None if self._additions is None else unknown_additions
        kept = {"page": page, "problem": problem, "_posed": posed, "_additions": additions}
        return {**self.__dict__, **kept}

    def __deepcopy__(self, memo: dict[int, Any]) -> StepProblem:
        """A new problem, its additions asked again, with the values and solution of this one."""
        self._check_posed()
        new = type(self)(self.template, self._additions)
        new.step = self.step
        for name, parameter in self.parameters.items():
            new.parameters[name].save_value(parameter.value)
        give_solution(new.problem, self.problem)
        return new

    def __repr__(self) -> str:
        step = self.template
        size = f"{step.n_v} unknowns, {step.m} rows"
        return f"<{type(self).__name__} of {size}: h = {step.h:g} s, cone {step.cone}>"

    def row(self, term: cp.Expression | cp.Constraint) -> cp.Constraint:
        """A constraint of one's own, divided by h^2 as the rows of the page are.

        Parameters
        ----------
        term : cvxpy.Expression or cvxpy.Constraint
            What is not to be negative, or a constraint, of ``delta_q`` [m, rad].

        Returns
        -------
        cvxpy.Constraint
            Of [m/s^2, rad/s^2]; its ``dual_value`` is a force [N, N m]. Of an equation it has
            CVXPY's sign: minus the force along its left side.
        """
        h2 = self.template.h**2
        return term / h2 >= 0 if isinstance(term, cp.Expression) else divided(term, by=h2)

    def cost(self, term: cp.Expression) -> cp.Expression:
        """A scalar cost of one's own [N m s], divided by h^3 as that of the page is [N m/s^2]."""
        return term / self.template.h**3

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
        self._set_values(None)

    def _set_values(self, natural: NaturalStep | None) -> None:
        placed = () if natural is None else (natural.units, natural.ends)
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows has no answer
            set_values(self.page, self.step, *placed)

    @keywords_named
    def solve(self, backend: str = "clarabel", accuracy: float = ACCURACY) -> Array:
        """A solver's answer to ``problem``, found in natural units; with additions in SI units.

        It is the solver's: nothing is proved. The problem then has its status and value, the
        variables and the multipliers of all constraints, in SI units, as after its own ``solve``.

        Parameters
        ----------
        backend : str
            One that CVXPY calls; upper case, as in CVXPY, is as good.
        accuracy : float
            Of the answer, in these units.

        Returns
        -------
        ndarray, shape (n_v,)
            delta_q [m, rad].

        Raises
        ------
        BackendError
            If it is unknown, not installed or not one that CVXPY calls, or does not take the
            problem's cones.
        InputError
            If another problem was put in place of this one.
        StepNotSolved
            If it claims anything but a full solution.
        """
        check_kind(backend, str, "backend", "the name of a backend")
        accuracy = positive_number(accuracy, "accuracy")
        name = bare(backend.lower())
        if backend.startswith(QPSOLVERS) or name == NONE or is_function(name):
            problem = "is not called through CVXPY; name another, or call solve_step"
            raise BackendError(problem, field="backend", value=backend)
        self._check_posed()
        entry = entry_of(name)
        if name == "highs":
            greeting_silenced()
        if not self.problem.is_qp():
            check_takes_cones(name, "this problem")
        attempts = entry.attempts(accuracy, not self.problem.is_qp())
        natural = NaturalStep(self.step) if self._additions is None else None
        self._set_values(natural)
        try:
            status = self._status([options for _, options in attempts], name)
        finally:
            self._set_values(None)
        if status != cp.OPTIMAL:
            raise StepNotSolved(name, status, self.step, attempts[-1][0])
        if natural is not None:
            self._unpack(page_units(natural.units, self.step.h))
        return self.primal()

    def _check_posed(self) -> None:
        """Refuse a problem that was put in the place of the step's: InputError."""
        if self.problem is not self._posed:
            words = "is another problem than that of this step; call its own solve()"
            raise InputError(words, field="StepProblem.problem")

    def _status(self, option_sets: Sequence[Options], name: str) -> str:
        """The status of the first full solution, else that of the last attempt."""
        status = ""
        for options in option_sets:
            try:
                status = cvxpy_reply(self, name, options).status
            except cp.error.DCPError:
                raise
            except Exception as error:  # whatever another package raises
                status = f"the solver failed: {error}"
            if status == cp.OPTIMAL:
                break
        return status

    def _unpack(self, units: Units) -> None:
        """Put a solution in other units back into the problem, in SI units."""
        solution = self.problem.solution
        S_a, S_u = np.split(units.size * units.coordinate, [self.step.n_a])
        factors = {self.a_a.id: S_a, self.a_u.id: S_u}
        force = units.size / units.length
        solution.primal_vars = {key: x * factors[key] for key, x in solution.primal_vars.items()}
        for key, y in solution.dual_vars.items():  # of a second-order cone a list
            parts = [force * part for part in y] if isinstance(y, list) else force * y
            solution.dual_vars[key] = parts
        solution.opt_val *= units.size**2
        self.problem.unpack(solution)

    def primal(self) -> Array:
        """delta_q of the last solve, shape (n_v,)."""
        return np.asarray(self.delta_q.value, dtype=np.float64)

    def dual(self) -> Array | None:
        """Lam [N s] of the last solve, contact-major, the user's own rows last; shape (m,).

        The forces ``dual_value`` of the rows, times h.

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
        forces = np.concatenate([lam, *(row.dual_value for row in self.extra)])
        return np.asarray(template.h * forces)


def divided(constraint: cp.Constraint, by: float) -> cp.Constraint:
    """A constraint both of whose sides are divided `by` a number > 0 [any unit]."""
    if isinstance(constraint, cp.constraints.Inequality):
        return constraint.expr / by <= 0
    if isinstance(constraint, cp.constraints.Equality):
        return constraint.expr / by == 0
    return constraint.copy([part / by for part in constraint.args])  # a cone keeps its form


@dataclass(frozen=True, eq=False)
class ProblemData:
    """A compiled CVXPY problem: what ``cvxpy.Problem.get_problem_data`` returns.

    Parameters
    ----------
    numbers : dict
        The data of the solver: P, c, A, b and the cones, by CVXPY's words.
    chain : object
        CVXPY's; has ``solve_via_data``.
    inverse : list
        What ``unpack_results`` leads back to the problem with.
    """

    numbers: dict[str, Any]
    chain: Any
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
        self.units = page_units(si_units(template.n_v), template.h)

    @cached_property
    def problem(self) -> StepProblem:
        """The step's problem, which is compiled by the first answer."""
        return StepProblem(self.template)

    def write(self, natural: NaturalStep) -> Mask:
        """Fill the parameters; tell which rows are out of reach, shape (m,).

        Raises
        ------
        ValueError
            If CVXPY would compile the step for minutes.
        """
        if (n_c := natural.step.contacts.n_c) > MOST_CONTACTS:
            problem = (
                f"CVXPY takes too long to compile {n_c} contacts, more than {MOST_CONTACTS}; "
                "the backends daqp and none do without CVXPY"
            )
            raise ValueError(problem)
        set_values(self.problem.page, natural.step, natural.units, natural.ends)
        return natural.out_of_reach

    def reply_with(self, options: Options, natural: NaturalStep) -> Reply:
        """The backend's reply, from a cold start.

        Cold, so that a step replayed by itself takes the same path. (PROXQP's interface in CVXPY
        raises TypeError on a second warm start anyway.)
        """
        reply = cvxpy_reply(self.problem, self.bare_name, options)
        if reply.x is not None and reply.lam is not None:
            reply.x, reply.lam = in_si(reply.x, reply.lam, self.units)
        return reply


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
