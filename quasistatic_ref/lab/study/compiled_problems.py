"""Quadratic programs that CVXPY compiles once, as studies need them."""

import warnings

import cvxpy as cp
import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.problem_data import CANON
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.through_cvxpy import cvxpy_reply
from quasistatic_ref.step.standard_form import StandardForm


class CompiledProblem:
    """min 1/2 x'Hx - g'x, A x >= b, of which g alone is a parameter.

    Parameters
    ----------
    form : StandardForm
    name : str
        Of the backend that it is compiled for.
    """

    def __init__(self, form: StandardForm, name: str) -> None:
        n = len(form.g)
        self.form, self.x, self.g = form, cp.Variable(n), cp.Parameter(n, value=form.g)
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


class CompiledProblems:
    """A backend through CVXPY with the last program compiled, as a study needs it.

    Parameters
    ----------
    name : str
        Of the backend.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._last: CompiledProblem | None = None

    def reply(self, form: StandardForm, options: Options, warm: bool = False) -> Reply:
        """The reply to one program.

        Parameters
        ----------
        form : StandardForm
        options : dict
            In the backend's own names.
        warm : bool
            Start from the reply before, to a program with the same H, A and b.
        """
        program = self._last
        if program is None or not _same_but_for_g(program.form, form):
            program = self._last = CompiledProblem(form, self.name)
        if not warm:
            program.problem._solver_cache.clear()  # nothing is left of the reply before
        program.g.value = form.g
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of statuses, in words of each backend's own
            return cvxpy_reply(program, self.name, options, warm)


def _same_but_for_g(one: StandardForm, other: StandardForm) -> bool:
    return all(
        mine.shape == theirs.shape and abs(mine - theirs).sum() == 0
        for mine, theirs in zip(one, other, strict=True)
        if mine is not one.g
    )
