"""``exact_qp`` as a solver of qpsolvers, under the name ``exact``."""

from __future__ import annotations

from time import perf_counter
from typing import Any, Final

import qpsolvers
from qpsolvers import solvers
from qpsolvers.exceptions import ParamError, ProblemError

from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.qp.answer import NoOptimum, QPNotConvex
from quasistatic_ref.exact.qp.exact import exact_qp

NAME: Final = "exact"


def register_qpsolvers() -> None:
    """Add the solver ``"exact"`` to qpsolvers, for this process.

    After it, ``solve_qp``, ``solve_problem`` and ``solve_ls`` of qpsolvers take
    ``solver="exact"``. The ``extras`` of a solution have the :class:`.ExactQP` as ``answer``, or
    as ``proof`` why there is none. Where P is not convex, and where a number cannot be used, the
    error is qpsolvers' own, and our error is its cause.

    Examples
    --------
    >>> import qpsolvers
    >>> qr.register_qpsolvers()
    >>> P = np.diag([2.0, 2.0])
    >>> q = np.array([-2.0, -5.0])
    >>> qpsolvers.solve_qp(P, q, ub=np.array([0.5, 3.0]), solver="exact").tolist()
    [0.5, 2.5]
    """
    solvers.solve_function[NAME] = solved_problem
    for names in (solvers.available_solvers, solvers.dense_solvers, solvers.sparse_solvers):
        if NAME not in names:
            names.append(NAME)


def solved_problem(
    problem: Any, initvals: Any = None, verbose: bool = False, **options: object
) -> Any:
    """The ``qpsolvers.Solution`` of a ``qpsolvers.Problem``, as its ``solve_problem`` asks for it.

    Parameters
    ----------
    problem : qpsolvers.Problem
    initvals : array_like, shape (n,), or answer, optional
        As of :func:`.exact_qp`.
    verbose : bool
        Nothing is printed.
    **options
        There are none.

    Raises
    ------
    qpsolvers.ParamError
        If options are given.
    qpsolvers.ProblemError
        If P is not convex, or a number cannot be used.
    """
    for option in options:
        raise ParamError(f"{option}: is no option; the exact solver has none")
    begin = perf_counter()
    solution = qpsolvers.Solution(problem, found=False)
    try:
        answer = exact_qp(problem, initvals=initvals)
    except (InputError, QPNotConvex) as error:
        raise ProblemError(str(error)) from error
    except NoOptimum as proof:
        solution.extras = {"proof": proof}
    else:
        solution.found = True
        solution.extras = {"answer": answer}
        for name in ("x", "z", "y", "z_box", "obj"):
            setattr(solution, name, getattr(answer, name))
    solution.solve_time = perf_counter() - begin
    return solution
