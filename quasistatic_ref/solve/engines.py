"""The word `engine` of scenarios and the command line: it chooses the class of a solver."""

from quasistatic_ref.errors import BackendError
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.solve.backends import (
    BACKENDS,
    DEFAULT,
    DEFAULT_OF_RUNS,
    NONE,
    QPSOLVERS,
    backend,
)
from quasistatic_ref.solve.native import NativeSolver, check_native, native_backends
from quasistatic_ref.solve.solver import NoSolver, Solver
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData

CVXPY, NATIVE = "cvxpy", "native"
ENGINES = (CVXPY, NATIVE)


def check_solver(name: str, engine: str, cone_name: str) -> None:
    """Refuse an engine that there is not, or that does not reach a backend and a cone.

    Raises
    ------
    BackendError
    """
    if engine not in ENGINES:
        words = f"must be one of {', '.join(ENGINES)}{suggestion(str(engine), ENGINES)}"
        raise BackendError(words, field="engine", value=engine)
    if engine == NATIVE:
        check_native(name, cone_name)
    elif name != NONE:
        backend(name)


def default_backend(engine: str | None, cone_name: str, certify: str) -> str:
    """The backend of a simulator that names none.

    Natively, where every step is certified from rows: the fastest, since the bits are the same
    with any. Otherwise that of a single step, which takes all cones, extensions and large steps.
    """
    certified = certify == "full" and cone(cone_name).polyhedral
    return DEFAULT_OF_RUNS if certified and engine != CVXPY else DEFAULT


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
        ``"cvxpy"``, or ``"native"``: the backend's own interface, some ten times faster.

    Raises
    ------
    BackendError
        If the backend is unknown or not installed, or the engine does not reach it.
    """
    check_solver(name, engine, step.cone)
    if name == NONE:
        return NoSolver(step)
    # Others are imported when they are asked for: a short run takes less time than their packages.
    if engine == NATIVE:
        if not cone(step.cone).polyhedral:
            from quasistatic_ref.solve.second_order import ConeSolver

            return ConeSolver(step, name)
        if step.contacts.blocks is None:
            return NativeSolver(step, name)
        from quasistatic_ref.solve.sparse import SparseSolver

        return SparseSolver(step, name)
    if name.startswith(QPSOLVERS):
        from quasistatic_ref.solve.through_qpsolvers import QpsolversSolver

        return QpsolversSolver(step, name)
    from quasistatic_ref.solve.through_cvxpy import CvxpySolver

    return CvxpySolver(step, name)


def may_be_sparse(engine: str, name: str, certify: str, cone_name: str) -> bool:
    """Whether large steps may be handed over in blocks: natively, rows, not certified exactly."""
    takes = engine == NATIVE and name in BACKENDS and BACKENDS[name].sparse
    return takes and certify != "full" and cone(cone_name).polyhedral
