"""The table of backends: one accuracy, mapped to each solver's own options.

A backend is reached by two roads: through CVXPY under its name (``"clarabel"``), and through
qpsolvers, which hands over the standard form without CVXPY (``"qpsolvers:clarabel"``).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from quasistatic_ref.errors import BackendError, suggestion

Options = dict[str, Any]
QPSOLVERS = "qpsolvers:"


@dataclass(frozen=True)
class Backend:
    """One solver.

    Parameters
    ----------
    name : str
        Name of the setting; upper case it is CVXPY's, as it stands qpsolvers'.
    method : str
        What it does, in two words.
    options : callable
        Accuracy in natural units [-] -> the solver's own options.
    cvxpy : bool
        Whether CVXPY has an interface to it.
    required : bool
        Whether the package installs it.
    """

    name: str
    method: str
    options: Callable[[float], Options]
    cvxpy: bool = True
    required: bool = False


def _clarabel(accuracy: float) -> Options:
    tight = ("tol_gap_abs", "tol_gap_rel", "tol_feas", "tol_infeas_abs", "tol_infeas_rel")
    return dict.fromkeys(tight, accuracy) | {"max_iter": 500}


def _osqp(accuracy: float) -> Options:
    # Without polishing an ADMM method needs tens of thousands of iterations for the last digits.
    # Its rho must adapt by iterations, not by the clock, or runs would not repeat.
    return {
        "eps_abs": accuracy,
        "eps_rel": accuracy,
        "eps_prim_inf": accuracy,
        "eps_dual_inf": accuracy,
        "max_iter": 200_000,
        "polishing": True,
        "adaptive_rho_interval": 50,
        "verbose": False,
    }


def _piqp(accuracy: float) -> Options:
    # eps_abs alone leaves the duality gap at 1e-8: it must be asked for by name.
    tight = ("eps_abs", "eps_rel", "eps_duality_gap_abs", "eps_duality_gap_rel")
    return dict.fromkeys(tight, accuracy) | {"check_duality_gap": True, "max_iter": 500}


def _daqp(accuracy: float) -> Options:
    return {"primal_tol": accuracy, "dual_tol": accuracy}


def _proxqp(accuracy: float) -> Options:
    return {"eps_abs": accuracy, "eps_rel": 0.0, "max_iter": 20_000}


def _scs(accuracy: float) -> Options:
    return {"eps_abs": accuracy, "eps_rel": accuracy, "max_iters": 200_000}


def _highs(accuracy: float) -> Options:
    # HiGHS refuses tolerances below 1e-10 and can loop, hence the time limit.
    tight = max(accuracy, 1e-10)
    return {
        "primal_feasibility_tolerance": tight,
        "dual_feasibility_tolerance": tight,
        "time_limit": 10.0,
    }


def _nothing(accuracy: float) -> Options:
    del accuracy  # the method has no tolerance
    return {}


BACKENDS: dict[str, Backend] = {
    b.name: b
    for b in (
        Backend("clarabel", "interior point", _clarabel, required=True),
        Backend("osqp", "operator splitting", _osqp, required=True),
        Backend("piqp", "proximal interior point", _piqp, required=True),
        Backend("daqp", "dual active set", _daqp),
        Backend("proxqp", "augmented Lagrangian", _proxqp),
        Backend("scs", "operator splitting", _scs),
        Backend("highs", "active set", _highs),
        Backend("quadprog", "dual active set", _nothing, cvxpy=False),
    )
}
DEFAULT = "clarabel"


def installed_backends() -> list[str]:
    """Names that ``backend=`` accepts here: CVXPY's road first, then qpsolvers'."""
    import cvxpy
    import qpsolvers

    by_cvxpy = {name.lower() for name in cvxpy.installed_solvers()}
    through_cvxpy = [b.name for b in BACKENDS.values() if b.cvxpy and b.name in by_cvxpy]
    direct = [QPSOLVERS + n for n in BACKENDS if n in qpsolvers.available_solvers]
    return through_cvxpy + direct


def backend(name: str) -> Backend:
    """The table's entry for a name of either road.

    Raises
    ------
    BackendError
        If the name is unknown, or its solver is not installed.
    """
    known = installed_backends()
    entry = BACKENDS.get(name.removeprefix(QPSOLVERS))
    if entry is None:
        raise BackendError(
            f"is not a backend{suggestion(name, known)}", field="backend", value=name
        )
    if name not in known:
        remedy = f"pip install {entry.name}, or choose one of: {', '.join(known)}"
        raise BackendError(f"is not installed; {remedy}", field="backend", value=name)
    return entry
