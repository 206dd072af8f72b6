"""The table of backends: one accuracy, mapped to each solver's own options.

A backend is reached by two roads: through CVXPY under its name (``"clarabel"``), and through
qpsolvers, which hands over the standard form without CVXPY (``"qpsolvers:clarabel"``).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

from quasistatic_ref.errors import BackendError, suggestion

Options = dict[str, Any]
Attempts = tuple[Options, ...]
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
    attempts : callable
        Accuracy in natural units [-] -> sets of the solver's own options, tried in order until
        one of them solves the step.
    floor : float
        The accuracy that it can be asked for at most, in natural units [-].
    cvxpy : bool
        Whether CVXPY has an interface to it.
    package : str
        What to install, where its name is another.
    required : bool
        Whether the package installs it.
    cones : bool
        Whether it takes second-order cones, which the ellipsoid needs, through CVXPY.
    """

    name: str
    method: str
    attempts: Callable[[float], Attempts]
    floor: float = 0.0
    cvxpy: bool = True
    package: str = ""
    required: bool = False
    cones: bool = False


GAP = 1e-2
"""How much smaller than the residuals the duality gap of interior-point methods must be.

By strong convexity ||x - x*||_H^2 <= 2 gap: where a contact just begins to bear load, a gap of
1e-12 leaves an error of 1e-6 (measured on bunny_grasp: 8.7e-7; with 1e-14: 7e-8)."""


def _clarabel(accuracy: float) -> Attempts:
    feasibility = dict.fromkeys(("tol_feas", "tol_infeas_abs", "tol_infeas_rel"), accuracy)
    gap = dict.fromkeys(("tol_gap_abs", "tol_gap_rel"), GAP * accuracy)
    # Its static regularisation of 1e-8 is too much for steps with many dependent rows (any
    # sticking patch): 30 in 2,000 grasp steps end "optimal_inaccurate". At 1e-10 and at 1e-12
    # single other steps do, never the same ones.
    return tuple(
        feasibility
        | gap
        | {"static_regularization_constant": epsilon, "static_regularization_proportional": 0.0}
        | {"max_iter": 500}
        for epsilon in (1e-10, 1e-12, 1e-8)
    )


def _osqp(accuracy: float) -> Attempts:
    # No polishing: it prints to standard output, and improves none of the worst answers.
    common = {"eps_abs": accuracy, "eps_rel": 0.0, "max_iter": 50_000, "polishing": False}
    common |= {"eps_prim_inf": accuracy, "eps_dual_inf": accuracy, "verbose": False}
    # In natural units a fixed rho of about one suits nearly all steps, where the adaptive one
    # runs away to 1e6 on one step in ten; on a step in fifty it is the other way round.
    fixed = common | {"adaptive_rho": False, "rho": 0.3}
    return (fixed, common | {"adaptive_rho": True}, fixed | {"eps_abs": 10 * accuracy})


def _piqp(accuracy: float) -> Attempts:
    # eps_abs alone leaves the duality gap at 1e-8: it must be asked for by name.
    feasibility = dict.fromkeys(("eps_abs", "eps_rel"), accuracy)
    gap = dict.fromkeys(("eps_duality_gap_abs", "eps_duality_gap_rel"), GAP * accuracy)
    # With less regularisation than it comes with, its worst error on bunny_grasp falls from
    # 6e-8 to 5e-11.
    regularisation = {"reg_lower_limit": 1e-13, "reg_finetune_lower_limit": 1e-15}
    common = feasibility | regularisation | {"check_duality_gap": True, "max_iter": 500}
    # The gap is a difference of sums over all rows: with thousands of rows rounding alone leaves
    # 1e-14 to 4e-13 of it, at an answer that is right to 1e-14.
    rounded = dict.fromkeys(gap, accuracy)
    return (common | gap, common | rounded)


def _daqp(accuracy: float) -> Attempts:
    return ({"primal_tol": accuracy, "dual_tol": accuracy},)


def _proxqp(accuracy: float) -> Attempts:
    return ({"eps_abs": accuracy, "eps_rel": 0.0, "max_iter": 20_000},)


def _scs(accuracy: float) -> Attempts:
    return ({"eps_abs": accuracy, "eps_rel": accuracy, "max_iters": 200_000},)


def _highs(accuracy: float) -> Attempts:
    tight = ("primal_feasibility_tolerance", "dual_feasibility_tolerance")
    # It can loop, hence the time limit [s].
    return (dict.fromkeys(tight, accuracy) | {"time_limit": 10.0},)


def _nothing(accuracy: float) -> Attempts:
    del accuracy  # the method has no tolerance
    return ({},)


BACKENDS: dict[str, Backend] = {
    b.name: b
    for b in (
        Backend("clarabel", "interior point", _clarabel, required=True, cones=True),
        # On bunny_grasp OSQP's residuals stop falling between 1e-11 and 1e-10 at the worst steps.
        Backend("osqp", "operator splitting", _osqp, floor=1e-10, required=True),
        Backend("piqp", "proximal interior point", _piqp, required=True),
        Backend("daqp", "dual active set", _daqp),
        Backend("proxqp", "augmented Lagrangian", _proxqp, package="proxsuite"),
        Backend("scs", "operator splitting", _scs, cones=True),
        # HiGHS refuses tolerances below 1e-10.
        Backend("highs", "active set", _highs, floor=1e-10, package="highspy"),
        Backend("quadprog", "dual active set", _nothing, cvxpy=False),
    )
}
DEFAULT = "clarabel"
NONE = "none"
"""No backend: the exact method from a cold start."""


@cache  # CVXPY tries to import every solver it knows: 2 ms
def installed_backends() -> tuple[str, ...]:
    """Names that ``backend=`` accepts here: CVXPY's road first, then qpsolvers'."""
    import cvxpy
    import qpsolvers

    by_cvxpy = {name.lower() for name in cvxpy.installed_solvers()}
    through_cvxpy = [b.name for b in BACKENDS.values() if b.cvxpy and b.name in by_cvxpy]
    direct = [QPSOLVERS + n for n in BACKENDS if n in qpsolvers.available_solvers]
    return (*through_cvxpy, *direct)


def backend(name: str) -> Backend:
    """The table's entry for a name of either road.

    Raises
    ------
    BackendError
        If the name is unknown, or its solver is not installed.
    """
    known = (*installed_backends(), NONE)
    entry = BACKENDS.get(name.removeprefix(QPSOLVERS)) if isinstance(name, str) else None
    if entry is None:
        hint = suggestion(str(name), known)
        raise BackendError(f"is not a backend{hint}", field="backend", value=name)
    if name not in known:
        other = QPSOLVERS + name
        remedy = f"is reached as {other!r}" if other in known else "is not installed"
        if other not in known:
            remedy += f"; pip install {entry.package or entry.name}"
        choices = ", ".join(known)
        raise BackendError(f"{remedy}; choices here: {choices}", field="backend", value=name)
    return entry


def cone_backend(name: str, what: str) -> None:
    """Refuse a backend that takes linear rows only.

    Parameters
    ----------
    name : str
    what : str
        What needs more than rows, as the subject of a sentence.

    Raises
    ------
    BackendError
        If it takes no cones, is unknown or is not installed.
    """
    if name == NONE:
        return
    if not backend(name).cones or name.startswith(QPSOLVERS):
        able = ", ".join(b.name for b in BACKENDS.values() if b.cones)
        raise BackendError(f"takes linear rows only; {what} needs one of {able}", field="backend",
                           value=name)  # fmt: skip
