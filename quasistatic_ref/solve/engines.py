"""The word `engine` of scenarios and the command line: it chooses the class of a solver."""

import math

from quasistatic_ref.errors import BackendError, InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.solve.backends import (
    BACKENDS,
    DEFAULT,
    DEFAULT_OF_LARGE,
    DEFAULT_OF_RUNS,
    NONE,
    QPSOLVERS,
    backend,
    cone_backend,
)
from quasistatic_ref.solve.native import NativeSolver, check_native, native_backends
from quasistatic_ref.solve.solver import NoSolver, Solver
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Contacts, StepData
from quasistatic_ref.tolerances import DENSE_BELOW, SPARSE_FROM_PIQP

CVXPY, NATIVE = "cvxpy", "native"
ENGINES = (CVXPY, NATIVE)
CERTIFY = ("full", "residual", "off")


def check_solver(name: str, engine: str, cone_name: str, certify: str = CERTIFY[0]) -> None:
    """Refuse what no step can be solved with: before a run, rather than in its first step.

    Parameters
    ----------
    name : str
        Of a backend, or ``"none"``.
    engine : str
    cone_name : str
    certify : str

    Raises
    ------
    BackendError
        If the engine does not exist, or does not reach the backend; if that does not take the cone,
        or gives no answer that could be certified so.
    InputError
        If there is no such way to certify.
    """
    if engine not in ENGINES:
        words = f"must be one of {', '.join(ENGINES)}{suggestion(str(engine), ENGINES)}"
        raise BackendError(words, field="engine", value=engine)
    check_certify(name, certify)
    if engine == NATIVE:
        check_native(name, cone_name)
    elif name != NONE:
        backend(name)
        if not cone(cone_name).polyhedral:
            cone_backend(name, f"the {cone_name}")


def check_certify(name: str, certify: str) -> None:
    """Refuse no way to certify (InputError), and one that needs a backend (BackendError)."""
    if certify not in CERTIFY:
        raise InputError(f"must be one of {', '.join(CERTIFY)}", field="certify", value=certify)
    if name == NONE and certify != CERTIFY[0]:
        problem = f"gives no answer of its own; use certify = {CERTIFY[0]!r}"
        raise BackendError(problem, field="backend", value=NONE)


def default_backend(engine: str | None, cone_name: str, certify: str, entries: int = 0) -> str:
    """The backend of a simulator that names none: natively the fastest, otherwise DEFAULT.

    Parameters
    ----------
    engine : str or None
    cone_name : str
    certify : str
    entries : int
        Entries of a step's dense J, 4 n_c n_v, where its contacts may be in blocks; otherwise 0.
    """
    if engine == CVXPY or not cone(cone_name).polyhedral:
        return DEFAULT
    # Rows that are certified exactly are dense, and have the same bits with any backend.
    sparse = {"full": math.inf, "residual": SPARSE_FROM_PIQP, "off": DENSE_BELOW}
    return DEFAULT_OF_LARGE if entries >= sparse.get(certify, math.inf) else DEFAULT_OF_RUNS


def default_engine(name: str, cone_name: str) -> str:
    """The engine of a simulator that names none: native where that reaches backend and cone.

    What is certified has the same bits either way.
    """
    return NATIVE if name in native_backends(cone_name) else CVXPY


def solver_for(step: StepData, name: str, engine: str = CVXPY) -> Solver:
    """A solver of steps like this one, sparse if its contacts are in blocks.

    Parameters
    ----------
    step : StepData
    name : str
        Of the backend; with ``qpsolvers:`` it is reached without CVXPY.
    engine : str
        ``"cvxpy"``, or ``"native"``: the backend's own interface, which is faster.

    Raises
    ------
    BackendError
        If the backend is unknown or not installed, or the engine does not reach it.
    """
    check_solver(name, engine, step.cone)
    if name == NONE:
        return NoSolver(step)
    # The classes are imported where they are used: their packages take longer than a short run.
    if engine == NATIVE:
        if not cone(step.cone).polyhedral:
            from quasistatic_ref.optional.ellipsoid.second_order import ConeSolver

            return ConeSolver(step, name)
        if isinstance(step.contacts, Contacts):
            return NativeSolver(step, name)
        from quasistatic_ref.optional.large.sparse import SparseSolver

        return SparseSolver(step, name)
    if name.startswith(QPSOLVERS):
        from quasistatic_ref.solve.through_qpsolvers import QpsolversSolver

        return QpsolversSolver(step, name)
    from quasistatic_ref.solve.through_cvxpy import CvxpySolver

    return CvxpySolver(step, name)


def sparse_from(engine: str, name: str, certify: str, cone_name: str) -> int:
    """Entries of J, 4 n_c n_v, from which steps are handed over in blocks; 0 if they never are.

    They can be natively, where the cone is polyhedral and nothing is certified exactly.
    """
    may = engine == NATIVE and certify != "full" and cone(cone_name).polyhedral
    return BACKENDS[name].sparse if may and name in BACKENDS else 0
