"""Settings of a study: one accuracy in each solver's own options, on either road.

Plainer than :mod:`~quasistatic_ref.solve.backends`: residuals and duality gap are asked for at the
same accuracy, and nothing else is touched, as somebody would who read a solver's manual once.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from quasistatic_ref.solve.backends import BACKENDS, Options

OPTIONS: dict[str, Callable[[float], Options]] = {
    "clarabel": lambda eps: dict.fromkeys(("tol_feas", "tol_gap_abs", "tol_gap_rel"), eps),
    "osqp": lambda eps: {"eps_abs": eps, "eps_rel": 0.0, "max_iter": 20_000},
    "piqp": lambda eps: {
        "eps_abs": eps,
        "eps_rel": 0.0,
        "check_duality_gap": True,
        "eps_duality_gap_abs": eps,
        "eps_duality_gap_rel": 0.0,
    },
    "daqp": lambda eps: {"primal_tol": eps, "dual_tol": eps},
    "proxqp": lambda eps: {
        "eps_abs": eps,
        "eps_rel": 0.0,
        "check_duality_gap": True,
        "eps_duality_gap_abs": eps,
        "eps_duality_gap_rel": 0.0,
    },
    "scs": lambda eps: {"eps_abs": eps, "eps_rel": 0.0, "max_iters": 20_000},
    # HiGHS refuses tolerances below 1e-10.
    "highs": lambda eps: dict.fromkeys(
        ("primal_feasibility_tolerance", "dual_feasibility_tolerance"), max(eps, 1e-10)
    ),
    "qpalm": lambda eps: {"eps_abs": eps, "eps_rel": 0.0, "max_iter": 20_000},
}
"""Solvers that have an accuracy to set. quadprog has none: it is asked at its default only."""

TIME_LIMIT = {
    "clarabel": "time_limit",
    "osqp": "time_limit",
    "scs": "time_limit_secs",
    "highs": "time_limit",
}
"""The option of solvers that can stop themselves; others are killed from outside."""

DIRECT = ("clarabel", "osqp", "piqp", "daqp", "proxqp", "scs", "highs", "quadprog", "qpalm")
BY_CVXPY = tuple(name for name in DIRECT if name != "quadprog")
PACKAGE = {"proxqp": "proxsuite", "highs": "highspy"}
"""What to install, where its name is another."""

WARM = {
    "qpsolvers": ("daqp", "osqp", "proxqp", "qpalm", "scs"),
    "cvxpy": ("clarabel", "highs", "osqp", "piqp", "proxqp", "qpalm", "scs"),
}
"""Solvers to which that road hands on a start; qpsolvers' others drop it, and so does CVXPY's
interface to DAQP. (Of an interior point a warm start reuses the set-up, not the point.)"""


@cache
def installed_solvers(road: str) -> tuple[str, ...]:
    """Solvers of this table that are installed, by ``"cvxpy"`` or ``"qpsolvers"``."""
    import cvxpy
    import qpsolvers

    if road == "cvxpy":
        here = {name.lower() for name in cvxpy.installed_solvers()}
        return tuple(name for name in BY_CVXPY if name in here)
    return tuple(name for name in DIRECT if name in qpsolvers.available_solvers)


def plain_options(solver: str, accuracy: float | None) -> Options:
    """One accuracy in a solver's own options; none for None, which is its default.

    Parameters
    ----------
    solver : str
    accuracy : float or None

    Returns
    -------
    dict
    """
    return {} if accuracy is None else OPTIONS[solver](accuracy)


def tuned_options(solver: str, accuracy: float) -> Options:
    """The options that this package's simulator tries first, where it knows the solver."""
    if solver not in BACKENDS:
        return OPTIONS[solver](accuracy)
    entry = BACKENDS[solver]
    return dict(entry.attempts(max(accuracy, entry.floor))[0])


def time_option(solver: str, seconds: float) -> Options:
    """The option by which a solver stops itself after `seconds` [s], if it has one."""
    return {TIME_LIMIT[solver]: seconds} if solver in TIME_LIMIT else {}
