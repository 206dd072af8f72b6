"""The two ways in which a step reaches a solver."""

from __future__ import annotations

from quasistatic_ref.errors import BackendError, suggestion
from quasistatic_ref.solve.native import native_backends
from quasistatic_ref.step.cones import cone

CVXPY, NATIVE = "cvxpy", "native"
ENGINES = (CVXPY, NATIVE)


def check_engine(name: str) -> None:
    """Refuse what is no engine.

    Raises
    ------
    BackendError
    """
    if name not in ENGINES:
        hint = suggestion(str(name), ENGINES)
        raise BackendError(f"must be one of {', '.join(ENGINES)}{hint}", field="engine", value=name)


def default_engine(backend: str, cone_name: str) -> str:
    """The engine of a simulator that names none: native where that reaches backend and cone.

    What is certified has the same bits either way.
    """
    reached = backend in native_backends() and cone(cone_name).polyhedral
    return NATIVE if reached else CVXPY
