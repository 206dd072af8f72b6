"""What a solver makes of its options: a name that it does not know, or a value that it refuses.

Doors drop some of them in silence, and a study would print them as promises. So each solver is
given its options here before a study runs, and what it then has is read back where it lets read.
"""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

import numpy as np
from scipy.sparse import csc_matrix

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.greeting import greeting_silenced

OF_THE_DOOR: Mapping[str, tuple[str, ...]] = {
    "qpsolvers": ("verbose", "backend"),
    "cvxpy": ("verbose", "backend", "raise_error", "use_quad_obj", "max_iters"),
}
"""Names that a door takes for itself."""
HANDED_ON: Mapping[tuple[str, str], Callable[[], tuple[str, ...]]] = {
    ("cvxpy", "daqp"): lambda: (
        import_module("cvxpy.reductions.solvers.qp_solvers.daqp_qpif").DAQP.ALLOWED_SOLVER_OPTS
    ),
    ("cvxpy", "proxqp"): lambda: ("eps_abs", "eps_rel", "max_iter", "rho", "mu_eq", "mu_in"),
}
"""All names that a door hands on, where it drops others in silence."""
NO_ATTRIBUTES: Mapping[str, tuple[str, ...]] = {
    "cvxopt": ("abstol", "feastol", "kktreg", "kktsolver", "maxiters", "refinement", "reltol"),
    "ecos": ("abstol", "abstol_inacc", "feastol", "feastol_inacc", "max_iters", "reltol",
             "reltol_inacc"),
    "quadprog": (),
}  # fmt: skip
"""The names that the documentation of a solver lists, where it keeps any other without a word."""


def _attributes(settings: Any, options: Options) -> Options:
    """Options as attributes of a settings object, set and read back."""
    for name, value in options.items():
        setattr(settings, name, value)
    return {name: getattr(settings, name) for name in options}


def _osqp(options: Options) -> Options:
    solver = import_module("osqp").OSQP()
    one = csc_matrix(np.eye(1))
    solver.setup(one, np.zeros(1), one, np.zeros(1), np.ones(1), **{"verbose": False} | options)
    return {name: getattr(solver.settings, name) for name in options}


def _scs(options: Options) -> Options:
    data = {"P": csc_matrix(np.eye(1)), "c": np.zeros(1), "A": csc_matrix(np.eye(1)),
            "b": np.ones(1)}  # fmt: skip
    import_module("scs").SCS(data, {"l": 1}, **{"verbose": False} | options)
    return options


def _daqp(options: Options) -> Options:
    one = np.eye(1)
    bounds = (np.ones(1), np.zeros(1), np.zeros(1, dtype=np.int32))
    import_module("daqp").solve(one, np.zeros(1), one, *bounds, **options)
    return options


def _highs(options: Options) -> Options:
    greeting_silenced()
    highspy = import_module("highspy")
    solver = highspy.Highs()
    solver.silent()
    for name, value in options.items():
        if solver.getOptionValue(name)[0] != highspy.HighsStatus.kOk:
            raise AttributeError(name)
        if solver.setOptionValue(name, value) != highspy.HighsStatus.kOk:
            raise ValueError(f"{name} = {value!r}")
    return {name: solver.getOptionValue(name)[1] for name in options}


READ_BACK: Mapping[str, Callable[[Options], Options]] = {
    "clarabel": lambda options: _attributes(import_module("clarabel").DefaultSettings(), options),
    "daqp": _daqp,
    "highs": _highs,
    "osqp": _osqp,
    "piqp": lambda options: _attributes(import_module("piqp").DenseSolver().settings, options),
    "proxqp": lambda options: _attributes(
        import_module("proxsuite").proxqp.dense.QP(1, 0, 1).settings, options
    ),
    "qpalm": lambda options: _attributes(import_module("qpalm").Settings(), options),
    "scs": _scs,
}
"""Sets the options of a solver, and returns those that it then has; it raises if it refuses one."""


def check_options(door: str, solver: str, options: Options) -> None:
    """Refuse options that a solver would not get, or not take.

    Parameters
    ----------
    door : str
        ``"qpsolvers"`` or ``"cvxpy"``.
    solver : str
        Its name there, in lower case.
    options : dict
        In the solver's own names.

    Raises
    ------
    InputError
        If a name is unknown, a value is refused, or the solver has another value afterwards.

    Examples
    --------
    >>> from quasistatic_ref.lab.study.accepted import check_options
    >>> check_options("qpsolvers", "piqp", {"eps_absolute": 1e-12})
    Traceback (most recent call last):
        ...
    quasistatic_ref.errors.InputError: eps_absolute: is not an option of qpsolvers:piqp (got 1e-12)
    """
    label = f"{door}:{solver}"
    handed_on = {name: v for name, v in options.items() if name not in OF_THE_DOOR[door]}
    known = NO_ATTRIBUTES.get(solver)
    if (door, solver) in HANDED_ON:
        known = HANDED_ON[door, solver]()
    for name, value in handed_on.items():
        if known is not None and name not in known:
            words = f"is not an option of {label}{suggestion(name, known)}"
            raise InputError(words, field=name, value=value)
        try:
            kept = READ_BACK.get(solver, dict)({name: value})
        except Exception as error:  # each package raises errors of its own
            unknown = isinstance(error, AttributeError)
            problem = f"is not an option of {label}" if unknown else f"is refused by {label}"
            raise InputError(problem, field=name, value=value) from None
        if kept[name] != value:
            raise InputError(f"is {kept[name]!r} after {label} was given it", field=name,
                             value=value)  # fmt: skip
