"""Three doors to a solver: qpsolvers, CVXPY, and a function of one's own."""

import pickle
import zlib
from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.claims import INFEASIBLE, OPTIMAL
from quasistatic_ref.lab.study.solvers import CVXPY, QPSOLVERS, Solver
from quasistatic_ref.optional.extensions.by_function import real_numbers
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.standard_form import StandardForm

Call = Callable[[StandardForm, Options, Reply | None], Reply]
"""(problem, options, reply to start from or None) -> reply."""
NEAR = 0.01
"""How far the neighbour's g is from the problem's, entry by entry and relative: a warm start comes
from the answer to the neighbour, as it does from the step before."""
WORDS = 200
"""Characters of what a solver raised that are kept."""


def neighbour(form: StandardForm, name: str) -> StandardForm:
    """The problem that a warm start comes from: each g_i changed by up to 1 %.

    Parameters
    ----------
    form : StandardForm
    name : str
        Of the problem; the change is a function of it.
    """
    rng = np.random.default_rng(zlib.crc32(name.encode()))
    return form._replace(g=form.g * (1 + NEAR * rng.uniform(-1, 1, len(form.g))))


def call_of(solver: Solver) -> Call:
    """The function that puts a problem to a solver.

    What a solver raises is a reply that has failed.

    Parameters
    ----------
    solver : Solver

    Raises
    ------
    InputError
        If a function is of a module that cannot be imported here.
    """
    if solver.door == CVXPY:
        call = _by_cvxpy(solver.target)
    elif solver.door == QPSOLVERS:
        call = _by_qpsolvers(solver.target)
    else:
        try:
            function = pickle.loads(solver.target)
        except Exception as error:  # a module may raise anything when it is imported
            words = f"cannot be imported: {type(error).__name__}: {error}"
            raise InputError(words[:WORDS], field=solver.name) from None
        call = _by_function(function, solver.warm)

    def safe(form: StandardForm, options: Options, before: Reply | None) -> Reply:
        try:
            return call(form, options, before)
        except Exception as error:  # whatever another package raises
            words = " ".join(f"{type(error).__name__}: {error}".split())
            return Reply(None, None, False, words[:WORDS])

    return safe


def _by_cvxpy(name: str) -> Call:
    from quasistatic_ref.lab.study.compiled_problems import CompiledProblems  # heavy: CVXPY

    programs = CompiledProblems(name)
    return lambda form, options, before: programs.reply(form, options, warm=before is not None)


def _by_qpsolvers(name: str) -> Call:
    from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply

    return lambda form, options, before: qpsolvers_reply(
        form, name, options, None if before is None else before.x
    )


def _by_function(function: Callable[..., Any], starts: bool) -> Call:
    """A function, which starts from its own answer where it takes one."""

    def call(form: StandardForm, options: Options, before: Reply | None) -> Reply:
        if starts and before is not None:
            options = options | {"start": (before.x, before.lam)}
        numbers = (form.H.copy(), -form.g, -form.A, -form.b)
        begin = perf_counter()
        returned = function(*numbers, **options)
        seconds = perf_counter() - begin
        if not isinstance(returned, tuple) or len(returned) != 3:
            words = f"returned a {type(returned).__name__} in place of (x, z, status)"
            return Reply(np.zeros((0, 0)), None, False, words, call_seconds=seconds)
        x, z, status = returned
        if not isinstance(status, str):
            words = f"returned a {type(status).__name__} in place of a status"
            return Reply(None, None, False, words, call_seconds=seconds)
        x = None if x is None or status == INFEASIBLE else real_numbers(x)
        lam = None if z is None else real_numbers(z)
        return Reply(x, lam, status == OPTIMAL, status[:WORDS], call_seconds=seconds)

    return call
