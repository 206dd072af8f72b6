"""Solvers of steps: only this file knows where the package keeps what tests ask of them."""

from quasistatic_ref.solve.backends import (
    BACKENDS,
    DEFAULT,
    NONE,
    UNSAFE,
    installed_backends,
    others_installed,
)
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.natural_step import NaturalStep
from quasistatic_ref.solve.solver import FREE, Reply

__all__ = [
    "BACKENDS",
    "DEFAULT",
    "FREE",
    "NONE",
    "UNSAFE",
    "NaturalStep",
    "Reply",
    "installed_backends",
    "others_installed",
    "solver_for",
]
