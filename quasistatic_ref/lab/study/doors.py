"""Three doors to a solver: qpsolvers, CVXPY, and a function of one's own."""

import pickle
from collections.abc import Callable
from time import perf_counter
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.program import Program
from quasistatic_ref.lab.study.saying import INFEASIBLE, SOLVED, saying
from quasistatic_ref.lab.study.solvers import CVXPY, FUNCTION, QPSOLVERS, Solver
from quasistatic_ref.optional.extensions.by_function import real_numbers
from quasistatic_ref.quoting import one_line
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.solver import Reply
from quasistatic_ref.step.standard_form import StandardForm
from quasistatic_ref.text.plain import bits

Call = Callable[[Program, Options], Reply]
WORDS = 200
"""Characters of what a solver raised that are kept."""


def call_of(solver: Solver) -> Call:
    """The function that puts a program to a solver.

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
        call = _by_function(function)

    def safe(program: Program, options: Options) -> Reply:
        try:
            reply = call(program, options)
        except Exception as error:  # whatever another package raises
            words = " ".join(f"{type(error).__name__}: {error}".split())
            reply = Reply(None, None, False, words[:WORDS])
        reply.status = one_line(reply.status)
        return reply

    return safe


def _by_cvxpy(name: str) -> Call:
    from quasistatic_ref.lab.study.compiled_problems import CompiledProblem  # heavy: CVXPY
    from quasistatic_ref.solve.step_problem import cvxpy_reply

    last: CompiledProblem | None = None

    def call(program: Program, options: Options) -> Reply:
        nonlocal last
        if last is None or bits(last.program) != bits(program):
            last = CompiledProblem(program, name)
        return cvxpy_reply(last, name, options)

    return call


def _by_qpsolvers(name: str) -> Call:
    from quasistatic_ref.optional.qpsolvers.through_qpsolvers import qpsolvers_reply

    def call(program: Program, options: Options) -> Reply:
        return qpsolvers_reply(StandardForm(*program[:4]), name, options, program.equations)

    return call


def _by_function(function: Callable[..., Any]) -> Call:
    def call(program: Program, options: Options) -> Reply:
        H, g, A, b, e = program
        equations = {"A": A[:e].copy(), "b": b[:e].copy()} if e else {}
        numbers = (H.copy(), -g, -A[e:], -b[e:])
        begin = perf_counter()
        returned = function(*numbers, **equations, **options)
        seconds = perf_counter() - begin
        wanted = "(x, z, y, status)" if e else "(x, z, status)"
        if not isinstance(returned, tuple) or len(returned) != len(wanted.split()):
            words = f"returned a {type(returned).__name__} in place of {wanted}"
            return Reply(None, None, False, words, call_seconds=seconds)
        x, *multipliers, status = returned
        if not isinstance(status, str):
            words = f"returned a {type(status).__name__} in place of a status"
            return Reply(None, None, False, words, call_seconds=seconds)
        says = saying(FUNCTION, "", status)
        x = None if x is None or says == INFEASIBLE else real_numbers(x)
        z, *y = (None if one is None else real_numbers(one) for one in multipliers)
        lam = z
        if e and z is not None:
            lam = np.append(-y[0], z) if y[0] is not None else None
        return Reply(x, lam, says == SOLVED, status[:WORDS], call_seconds=seconds)

    return call
