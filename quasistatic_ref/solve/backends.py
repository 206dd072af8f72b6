"""Backends: how an accuracy is said in the options of each, and which of them are here.

A backend is a solver of another project. There are three interfaces to it: through CVXPY under its
name (``"clarabel"``); through qpsolvers (``"qpsolvers:clarabel"``), which hands over the standard
form, in an optional part; and, for DAQP alone, its own (``"daqp"``), in ``optional/daqp``, so that
through CVXPY it is called ``"cvxpy:daqp"``. A further one is a
:class:`~quasistatic_ref.solve.solver.Solver` in a file of its own, which ``solver_for`` chooses.
"""

import ctypes
import logging
import os
import re
import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Literal, TypeVar, get_args

from quasistatic_ref.errors import BackendError, InputError, about_field
from quasistatic_ref.parts import is_there, part
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.step.cones import checked_cone

T = TypeVar("T")
Options = dict[str, Any]
OptionSets = tuple[Options, ...]
QPSOLVERS = "qpsolvers:"
SolverNames = Callable[[], list[str]]
CVXPY = "cvxpy:"
DAQP = "daqp"
BY_CVXPY = CVXPY + DAQP

RELAXED = (1.0, 1e2, 1e4)
"""Accuracies tried where a backend is given second-order cones, relative to the one of the call.

Second-order cones cost Clarabel digits: of 40 planted steps it solves none at 1e-12, 39 at 1e-10
and all at 1e-9; of 40 grasp steps 37 at 1e-12 and all at 1e-11."""


@dataclass(frozen=True)
class Backend:
    """A solver as this package knows it: its name, its options for an accuracy, and its limits.

    Parameters
    ----------
    name : str
        Name of the backend: in lower case qpsolvers' name, in upper case CVXPY's.
    method : str
        Its method, in two words.
    option_sets : callable
        Accuracy in natural units [-] -> sets of the backend's own options, tried in order until
        one of them solves the step.
    floor : float
        The least accuracy that it takes, in natural units [-].
    cvxpy : bool
        Whether CVXPY has an interface to it.
    package : str
        What to install, where its name is another.
    required : bool
        Whether the package installs it.
    cones : bool
        Whether it takes second-order cones, which the ellipsoid needs, through CVXPY.
    no_steps : str
        Why no step is solved with it: it is in studies only, which end it after a time.
    returns : bool
        Whether it returned from every step that it was given. One that may end the process gets
        only steps whose rows are alike (``ALIKE`` in solver.py).
    """

    name: str
    method: str
    option_sets: Callable[[float], OptionSets]
    floor: float = 0.0
    cvxpy: bool = True
    package: str = ""
    required: bool = False
    cones: bool = False
    no_steps: str = ""
    returns: bool = True

    def attempts(self, accuracy: float, curved: bool = False) -> list[tuple[float, Options]]:
        """Accuracies in natural units [-] with options, in the order in which they are tried.

        Parameters
        ----------
        accuracy : float
            That is wanted.
        curved : bool
            Whether there are second-order cones.
        """
        least = max(accuracy, self.floor)
        tried = [k * least for k in (RELAXED if curved else (1.0,))]
        return [(one, options) for one in tried for options in self.option_sets(one)]

    @property
    def to_install(self) -> str:
        """The name under which pip installs the solver."""
        return self.package or self.name

    @property
    def to_install_it(self) -> str:
        """The command that installs the solver, as a message shows it."""
        alone = f"pip install {self.to_install}"
        return alone if self.required else f"{alone}, or 'quasistatic-ref[study]' for every solver"


DUALITY_GAP = 1e-2
"""How much smaller than the residuals the duality gap of interior-point methods must be.

By strong convexity ||x - x*||_H^2 <= 2 gap: where a contact just begins to bear load, a gap of
1e-12 leaves an error of 1e-6 (Clarabel on bunny_grasp: 5e-7; with 1e-14: 6e-8)."""


def _clarabel(accuracy: float) -> OptionSets:
    feasibility = dict.fromkeys(("tol_feas", "tol_infeas_abs", "tol_infeas_rel"), accuracy)
    gap = dict.fromkeys(("tol_gap_abs", "tol_gap_rel"), DUALITY_GAP * accuracy)
    # With its default static regularisation of 1e-8 it stops early on 4 of the 300 steps of
    # bunny_grasp, whose sticking patches have many dependent rows. With 1e-10 or 1e-12 it solves
    # them, but fails on single steps of other scenes, never on the same ones: all three are tried.
    return tuple(
        feasibility
        | gap
        | {"static_regularization_constant": epsilon, "static_regularization_proportional": 0.0}
        | {"max_iter": 500, "input_sparse_dropzeros": True}  # M_u of many bodies is mostly zeros
        for epsilon in (1e-10, 1e-12, 1e-8)
    )


def _osqp(accuracy: float) -> OptionSets:
    # No polishing: it prints to standard output, and improves none of the worst answers.
    common = {"eps_abs": accuracy, "eps_rel": 0.0, "max_iter": 50_000, "polishing": False}
    common |= {"eps_prim_inf": accuracy, "eps_dual_inf": accuracy, "verbose": False}
    # In natural units a fixed rho of about one suits nearly all steps (of bunny_grasp with and
    # without torsion all but 11 of 600), where the adaptive one, which may run away to 1e6, leaves
    # 34 unsolved.
    fixed = common | {"adaptive_rho": False, "rho": 0.3}
    return (fixed, common | {"adaptive_rho": True}, fixed | {"eps_abs": 10 * accuracy})


def _piqp(accuracy: float) -> OptionSets:
    # eps_abs alone leaves the duality gap at 1e-8: it must be set by name.
    feasibility = dict.fromkeys(("eps_abs", "eps_rel"), accuracy)
    gap = dict.fromkeys(("eps_duality_gap_abs", "eps_duality_gap_rel"), DUALITY_GAP * accuracy)
    # With less regularisation than it comes with, its worst error on bunny_grasp falls from
    # 7e-8 to 2e-10.
    regularisation = {"reg_lower_limit": 1e-13, "reg_finetune_lower_limit": 1e-15}
    common = feasibility | regularisation | {"check_duality_gap": True, "max_iter": 500}
    # With so little regularisation it stalls at single steps of a heap; its defaults solve them.
    regularised = {
        "reg_lower_limit": 1e-10,
        "reg_finetune_lower_limit": 1e-13,
        "preconditioner_iter": 10,
    }
    # The gap is a difference of sums over all rows: with thousands of rows rounding alone leaves
    # 1e-14 to 4e-13 of it, at an answer that is right to 1e-14.
    rounded = dict.fromkeys(gap, accuracy)
    return (common | gap, common | rounded, common | rounded | regularised)


def at_accuracy(*names: str, **others: Any) -> Callable[[float], OptionSets]:
    """A set of options: `names` are set to the accuracy, `others` are fixed."""
    return lambda accuracy: (dict.fromkeys(names, accuracy) | others,)


# ProxQP has no time limit. Each of its outer iterations may take 1,500 inner ones of 20 us each, a
# limit that CVXPY does not pass on. The steps of bunny_grasp that it solves take at most 23 outer
# iterations.
_proxqp = at_accuracy("eps_abs", eps_rel=0.0, max_iter=100)
_scs = at_accuracy("eps_abs", "eps_rel", max_iters=200_000)
_daqp = at_accuracy("primal_tol", "dual_tol")
_qpalm = at_accuracy("eps_abs", eps_rel=0.0, max_iter=20_000)


def _highs(accuracy: float) -> OptionSets:
    tight = ("primal_feasibility_tolerance", "dual_feasibility_tolerance")
    refuses_less = max(accuracy, 1e-10)
    # It adds 1e-7 to the diagonal of H by default: 7.6 digits in place of 12.6, in the median.
    others = {"qp_regularization_value": 0.0, "time_limit": 5.0}  # it may loop
    return (dict.fromkeys(tight, refuses_less) | others,)


BACKENDS: dict[str, Backend] = {
    b.name: b
    for b in (
        Backend("clarabel", "interior point", _clarabel, required=True, cones=True),
        # At 1e-12 OSQP leaves more steps of bunny_grasp unsolved (docs/conventions.md).
        Backend("osqp", "operator splitting", _osqp, floor=1e-10, required=True),
        Backend("piqp", "proximal interior point", _piqp, required=True),
        Backend("daqp", "dual active set", _daqp, required=True),
        Backend("proxqp", "augmented Lagrangian", _proxqp, package="proxsuite"),
        Backend("scs", "operator splitting", _scs, cones=True),
        Backend("highs", "active set", _highs, floor=1e-10, package="highspy", returns=False),
        # The method has no tolerance.
        Backend("quadprog", "dual active set", lambda _: ({},), cvxpy=False,
                no_steps="it may never return where rows depend on each other, as those of a "
                         "contact do"),
        Backend("qpalm", "augmented Lagrangian", _qpalm,
                no_steps="it says of some that have a solution that they have none"),
    )
}  # fmt: skip
REQUIRED = tuple(sorted(b.name for b in BACKENDS.values() if b.required))
"""Backends that the package installs."""
UNSAFE = frozenset(b.name for b in BACKENDS.values() if not b.returns)
"""Backends that did not return from every step."""
DEFAULT = "clarabel"
"""The backend where none is named: it takes every cone and every extension."""
NONE = "none"
"""No backend: the exact method, in a run from the working set of the step before."""


CANNOT_IMPORT = re.compile(r"Encountered unexpected exception importing solver (\w+)")
broken_solvers: dict[str, None] = {}
"""Those that CVXPY could not import, once it was imported itself."""


def _is_none_of_those(record: logging.LogRecord) -> bool:
    words = CANNOT_IMPORT.match(record.getMessage())
    if words is not None:
        broken_solvers[words[1].lower()] = None
    return words is None


logging.getLogger("__cvxpy__").addFilter(_is_none_of_those)


@cache
def greeting_silenced() -> None:
    """Discard what HiGHS prints when it starts."""
    highspy = import_module("highspy")
    sys.stdout.flush()
    try:
        kept = os.dup(1)
    except OSError:  # closed: there is nothing to disturb
        return
    null = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 1)
        highspy.Highs()
        ctypes.CDLL(None).fflush(None)
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(null)


@cache  # CVXPY tries to import every solver it knows: 2 ms
def reached(interface: str) -> tuple[str, ...]:
    """Names of all installed solvers that ``"cvxpy"`` or ``"qpsolvers"`` can call."""
    if not find_spec(interface):  # a light installation
        return ()
    if interface == "cvxpy":
        import cvxpy

        names = tuple(name.lower() for name in cvxpy.installed_solvers())
        for broken in broken_solvers:
            words = f"{broken} is installed, but cannot be imported, and is left out"
            warnings.warn(words, stacklevel=2)
        return names
    if not is_there("qpsolvers_names"):
        return ()
    qpsolvers_names: SolverNames = part("qpsolvers_names")
    return tuple(qpsolvers_names())


def installed(interface: str) -> tuple[str, ...]:
    """Names of the table's backends that are installed here and reached by an interface.

    Parameters
    ----------
    interface : str
        ``"cvxpy"`` or ``"qpsolvers"``.
    """
    have_it = [b.name for b in BACKENDS.values() if b.cvxpy or interface != "cvxpy"]
    return tuple(name for name in have_it if name in reached(interface))


def others_installed() -> tuple[str, ...]:
    """Names of installed solvers that are not in the table, those of qpsolvers with prefix."""
    names = [*reached("cvxpy"), *(QPSOLVERS + name for name in reached("qpsolvers"))]
    return tuple(name for name in names if name.removeprefix(QPSOLVERS) not in BACKENDS)


def known_to_cvxpy() -> set[str]:
    """Names of all solvers that CVXPY has an interface to, installed or not."""
    from cvxpy.settings import SOLVERS  # takes longer to import than a short run

    return {solver.lower() for solver in SOLVERS}


def is_function(name: str) -> bool:
    """Whether a backend's name is that of a function, ``MODULE:FUNCTION``."""
    return ":" in name and not name.startswith((QPSOLVERS, CVXPY))


def check_function(name: str | None) -> None:
    """Refuse the name of a function that is not there: InputError. Its module is run."""
    if name is not None and is_function(name):
        with about_field("solver.backend"):
            part("function_at")(name)


def bare(name: str) -> str:
    """A backend's name in the table: without the interface by which it is reached."""
    return name.removeprefix(QPSOLVERS).removeprefix(CVXPY)


def installed_backends() -> tuple[str, ...]:
    """Names of the installed backends: through CVXPY and DAQP's own first, then qpsolvers'."""
    by_cvxpy = (BY_CVXPY if name == DAQP else name for name in installed("cvxpy"))
    native = (DAQP,) if is_there("daqp_solver") and find_spec(DAQP) else ()
    names = (*by_cvxpy, *native, *(QPSOLVERS + name for name in installed("qpsolvers")))
    return tuple(name for name in names if not BACKENDS[bare(name)].no_steps)


def backend_names() -> tuple[str, ...]:
    """Every name of a backend that a user may write, ``"none"`` included."""
    return (*installed_backends(), NONE)


def name_here(name: T) -> T | str:
    """The name here of what CVXPY calls ``cvxpy.OSQP``, in upper case; any other stays as it is.

    ``cvxpy.DAQP`` is DAQP through CVXPY.
    """
    if not isinstance(name, str) or not name.isupper() or ":" in name:
        return name
    return BY_CVXPY if name.lower() == DAQP else name.lower()


def backend(name: str) -> Backend:
    """The table's entry for a name, with or without the interface.

    A solver that is not in the table, but that CVXPY or qpsolvers has installed, is called with its
    own options; so is a function, ``MODULE:FUNCTION``.

    Raises
    ------
    BackendError
        If the name is unknown, or its solver is not installed.
    """
    if name.startswith(QPSOLVERS):
        part("qpsolvers_solver", name)  # or its sentence
    elif name == DAQP:
        part("daqp_solver")
        if find_spec(DAQP):
            return BACKENDS[DAQP]
    elif is_function(name):
        return Backend(name, "a function", lambda _: ({},), cvxpy=False)
    elif name in REQUIRED and find_spec(name):
        return BACKENDS[name]  # CVXPY is not asked: its import takes longer than a short run
    known = backend_names()
    entry = BACKENDS.get(bare(name))
    if entry is None and name in others_installed():
        return Backend(name, "not in this table", lambda _: ({},))
    if entry is not None and entry.no_steps:
        problem = f"is not a backend of steps: {entry.no_steps}; studies call it"
        raise BackendError(problem, field="backend", value=name)
    if entry is None:
        if name in known_to_cvxpy():
            problem = f"is not installed; installed here: {', '.join(known)}"
        else:
            problem = f"is not a backend{suggestion(name, known)}"
        raise BackendError(problem, field="backend", value=name)
    if name not in known:
        other = QPSOLVERS + name
        if other in known:
            remedy = f"is available as {other!r}"
        else:
            remedy = f"is not installed; {entry.to_install_it}"
        choices = ", ".join(known)
        raise BackendError(f"{remedy}; installed here: {choices}", field="backend", value=name)
    return entry


def check_takes_cones(name: str, what: str) -> None:
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
        raise BackendError(f"accepts only linear rows; {what} needs one of {able}", field="backend",
                           value=name)  # fmt: skip


def fallbacks(name: str, cone_name: str, infeasible: bool) -> list[str]:
    """Names of what is asked in the place of a backend that failed, in this order.

    Parameters
    ----------
    name : str
        Of the backend.
    cone_name : str
    infeasible : bool
        Whether it said that there is no solution: a proof of that is then sought first.
    """
    curved = not checked_cone(cone_name).polyhedral
    able = [other for other in REQUIRED if BACKENDS[other].cones or not curved]
    there = [BY_CVXPY if other == DAQP and not is_there("daqp_solver") else other for other in able]
    others = [other for other in there if other != name]
    if curved:
        return others
    return [NONE, *others] if infeasible else [*others, NONE]


Certify = Literal["full", "residual", "off"]
CERTIFY: tuple[Certify, ...] = get_args(Certify)
"""Ways to certify an answer; :func:`~quasistatic_ref.solve.solve.solve_step` says what each is."""


def check_backend(name: str, cone_name: str, certify: str = CERTIFY[0]) -> None:
    """Refuse a combination of backend, cone and proof with which no step can be solved.

    Parameters
    ----------
    name : str
        Of a backend, or ``"none"``.
    cone_name : str
    certify : str

    Raises
    ------
    BackendError
        If the backend is unknown, not installed, does not take the cone, or gives no answer that
        could be certified so.
    InputError
        If there is no such way to certify.
    """
    check_certify(name, certify)
    if not isinstance(name, str):
        problem = "must be the name of a backend; a function solves single steps"
        raise BackendError(problem, field="backend", value=type(name).__name__)
    curved = not checked_cone(cone_name).polyhedral
    if name != NONE:
        backend(name)
        if curved:
            check_takes_cones(name, f"the {cone_name}")


def check_certify(name: str | None, certify: str) -> None:
    """Refuse a value of `certify` that is unknown, or that the backend ``"none"`` cannot give.

    Raises
    ------
    InputError
        If it does not exist.
    BackendError
        If it does not without a backend.
    """
    if not (isinstance(certify, str) and certify in CERTIFY):
        raise InputError(f"must be one of {', '.join(CERTIFY)}", field="certify", value=certify)
    if name == NONE and certify != CERTIFY[0]:
        problem = f"has no answer of its own; use certify = {CERTIFY[0]!r}"
        raise BackendError(problem, field="backend", value=NONE)
