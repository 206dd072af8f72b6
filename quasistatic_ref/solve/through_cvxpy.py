"""Through CVXPY: the step as the problem of the paper's page, and plain programs of studies."""

import warnings
from collections import OrderedDict
from time import perf_counter

import cvxpy as cp
import numpy as np

from quasistatic_ref.errors import BackendError
from quasistatic_ref.solve.adapters.program import Reply
from quasistatic_ref.solve.backends import DEFAULT, QPSOLVERS, Options, backend
from quasistatic_ref.solve.cvxpy_problem import CvxpyProblem
from quasistatic_ref.solve.scaled import DenseStep
from quasistatic_ref.solve.solver import KIND, Attempt, Solver
from quasistatic_ref.solve.units import out_of_reach, within_reach
from quasistatic_ref.step.data import Array, Mask, StepData
from quasistatic_ref.step.standard_form import StandardForm

CANON = cp.CPP_CANON_BACKEND
"""CVXPY's way of compiling, for problems of any size. From 1,000 parameters on it would choose
another by itself, which fails at a product of mu_v with J_1 delta_q (docs/studies.md)."""

KEPT = 2
"""Most compiled programs that are kept: one problem in raw and in natural units."""


class CvxpySolver(Solver):
    """The step's CVXPY problem, compiled once, and a backend that CVXPY has an interface to.

    Parameters
    ----------
    like : StepData
        A step of the kind that is to be solved.
    name : str
        Of the backend, without ``qpsolvers:``.

    Raises
    ------
    BackendError
        If CVXPY does not reach the backend here.
    """

    engine = "cvxpy"
    fixed = tuple(KIND)

    def __init__(self, like: StepData, name: str = DEFAULT) -> None:
        if backend(name).name != name:
            problem = f"is not reached through CVXPY; leave out {QPSOLVERS!r}"
            raise BackendError(problem, field="backend", value=name)
        super().__init__(like, name)
        self.problem = CvxpyProblem(like)

    def write(self, scaled: DenseStep) -> Mask:
        """Fill the parameters; tell which rows are out of reach, shape (m,)."""
        natural = scaled.natural
        self.problem.fill(within_reach(natural))
        return np.repeat(out_of_reach(natural), natural.counts)

    def reply(self, attempt: Attempt, scaled: DenseStep) -> Reply:
        """What the backend says, from a cold start.

        Cold, so that a step replayed by itself takes the same path. (PROXQP's interface in CVXPY
        raises TypeError on a second warm start anyway.)
        """
        return cvxpy_reply(self.problem, self.name, attempt.options, False)


def cvxpy_reply(
    compiled: "CvxpyProblem | PlainProgram", name: str, options: Options, warm: bool
) -> Reply:
    """The reply of a backend to a problem as its parameters stand.

    Parameters
    ----------
    compiled : CvxpyProblem or PlainProgram
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
    status, stats = str(problem.status), problem.solver_stats
    own, setup = (None if t is None else float(t) for t in (stats.solve_time, stats.setup_time))
    known = all(x.value is not None for x in problem.variables() if x.size)
    return Reply(
        compiled.primal() if known else None,
        compiled.dual() if known else None,
        status == cp.OPTIMAL,
        status,
        None if stats.num_iters is None else int(stats.num_iters),
        own,
        seconds,
        own,
        setup,
    )


class PlainProgram:
    """min 1/2 x'Hx - g'x, A x >= b, of which g alone is a parameter.

    Parameters
    ----------
    form : StandardForm
    name : str
        Of the backend that it is compiled for.
    """

    def __init__(self, form: StandardForm, name: str) -> None:
        n = len(form.g)
        self.H, self.x, self.g = form.H, cp.Variable(n), cp.Parameter(n, value=form.g)
        # H is known to be positive definite; CVXPY's check may err at condition numbers of 1e11.
        objective = cp.quad_form(self.x, cp.psd_wrap(form.H)) / 2 - self.g @ self.x
        self.rows = form.A @ self.x >= form.b
        self.problem = cp.Problem(cp.Minimize(objective), [self.rows])
        self.problem.get_problem_data(name.upper(), canon_backend=CANON, solver_opts={})

    def primal(self) -> Array:
        """The x of the last solve, shape (n,)."""
        return np.array(self.x.value, dtype=np.float64)

    def dual(self) -> Array | None:
        """Its multipliers, shape (m,), where the backend has any."""
        lam = self.rows.dual_value
        return None if lam is None else np.array(lam, dtype=np.float64)


class PlainPrograms:
    """A backend through CVXPY with the last few programs compiled, as a study needs it.

    Parameters
    ----------
    name : str
        Of the backend.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._compiled: OrderedDict[int, PlainProgram] = OrderedDict()

    def reply(self, form: StandardForm, options: Options, warm: bool = False) -> Reply:
        """The reply to one program.

        Parameters
        ----------
        form : StandardForm
        options : dict
            In the backend's own names.
        warm : bool
            Start from the reply before, to a program with the same H, A and b (the same arrays).
        """
        program = self._program(form)
        if not warm:
            program.problem._solver_cache.clear()  # nothing is left of the reply before
        program.g.value = form.g
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of statuses, in words of each backend's own
            return cvxpy_reply(program, self.name, options, warm)

    def _program(self, form: StandardForm) -> PlainProgram:
        key = id(form.H)  # which the program keeps, so that its identity stays its own
        if key not in self._compiled:
            self._compiled[key] = PlainProgram(form, self.name)
            while len(self._compiled) > KEPT:
                self._compiled.popitem(last=False)
        self._compiled.move_to_end(key)
        return self._compiled[key]
