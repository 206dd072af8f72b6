"""A solver behind qpsolvers, with its default settings, by its name: layer qp."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

import numpy as np
import qpsolvers
from door import Unsupported, answer


def version_of(solver: str) -> str:
    """Version of a solver's package."""
    package = {"highs": "highspy", "proxqp": "proxsuite", "qpalm": "qpalm"}.get(solver, solver)
    return f"{solver} {version(package)}"


def answered_by(solver: str) -> Callable[[Any], Any]:
    """Layer 5 by a solver: min 1/2 x'Px + q'x with G x <= h, so P = H, q = -g, G = -A, h = -b."""

    def qp(case: Any) -> Any:
        if "second_order" in case:
            raise Unsupported("second-order cones are no quadratic program")
        H, g, b = (np.array(case[key], dtype=float) for key in ("H", "g", "b"))
        A = np.array(case["A"], dtype=float).reshape(len(b), len(g))
        problem = qpsolvers.Problem(H, -g, -A if len(b) else None, -b if len(b) else None)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                found = qpsolvers.solve_problem(problem, solver=solver, **LIMITS.get(solver, {}))
        except (qpsolvers.exceptions.QPError, ValueError, RuntimeError) as error:
            raise Unsupported(f"{type(error).__name__}: {str(error)[:60]}") from None
        if not found.found or found.x is None:
            raise Unsupported("no solution found (or infeasible, without a proof)")
        lam = found.z if found.z is not None and len(b) else np.zeros(len(b))
        return {"delta_q": found.x, "lam": np.array(lam)}

    return qp


LIMITS: dict[str, dict[str, Any]] = {"highs": {"time_limit": 2.0}}

if __name__ == "__main__":
    answer(version_of(sys.argv[1]), {"qp": answered_by(sys.argv[1])})
