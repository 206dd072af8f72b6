"""Quadratic programs that CVXPY compiles once, as studies need them."""

import warnings
from collections import OrderedDict

import cvxpy as cp
import numpy as np

from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.compiled import CANON
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.through_cvxpy import cvxpy_reply
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

KEPT = 2
"""Most compiled programs that are kept: one problem in raw and in natural units."""


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


class CompiledProblems:
    """A backend through CVXPY with the last few programs compiled, as a study needs it.

    Parameters
    ----------
    name : str
        Of the backend.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._compiled: OrderedDict[int, CompiledProblem] = OrderedDict()

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

    def _program(self, form: StandardForm) -> CompiledProblem:
        key = id(form.H)  # which the program keeps, so that its identity stays its own
        if key not in self._compiled:
            self._compiled[key] = CompiledProblem(form, self.name)
            while len(self._compiled) > KEPT:
                self._compiled.popitem(last=False)
        self._compiled.move_to_end(key)
        return self._compiled[key]
