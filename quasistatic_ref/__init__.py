"""Reference implementation of convex quasi-dynamic simulation with torsional friction.

The model is that of Tracy & Manchester, "Convex Quasi-Dynamic Simulation of Rigid Point
Clouds with Torsional Friction"; equation numbers everywhere in this package are the paper's.
Start reading at :mod:`quasistatic_ref.step.problem`.

The names below are loaded on first use, so that ``import quasistatic_ref`` is cheap and
``step``, ``certify`` and ``solve`` work where pinocchio and coal are not installed.
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_HOME = {
    "QuasistaticError": "errors",
    "StepNotSolved": "errors",
    "Contacts": "step.data",
    "StepData": "step.data",
    "StepSolution": "step.solution",
    "Extension": "step.extension",
    "StepProblem": "step.problem",
    "sensitivity": "certify.sensitivity",
    "solve_step": "solve.solve",
    "System": "model.system",
    "Simulator": "simulate.simulator",
    "Trajectory": "simulate.trajectory",
    "load_scenario": "simulate.scenario",
}

__all__ = ["__version__", *sorted(_HOME)]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return __all__
