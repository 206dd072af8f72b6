"""The solvers of a study, by the door through which they are called, and their settings."""

import importlib.metadata
import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.parts import needed_package
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.solve.backends import BACKENDS, Options, installed

QPSOLVERS, CVXPY, FUNCTION = ("qpsolvers", "cvxpy", "function")
"""Matrices to qpsolvers; a problem to CVXPY; ``(P, q, G, h, **options) -> (x, z, status)``."""
BY_NAME = (QPSOLVERS, CVXPY)


@dataclass(frozen=True)
class Setting:
    """An accuracy, which is other options for each solver.

    Parameters
    ----------
    name : str
    accuracy : float or None
        Of residuals and gap, in the units of the problem as given [-]; None: the default.
    tuned : bool
        The options that the simulator uses in place of the plain ones.
    """

    name: str
    accuracy: float | None
    tuned: bool = False


SETTINGS = (
    Setting("default", None),
    Setting("low", 1e-3),
    Setting("mid", 1e-6),
    Setting("high", 1e-9),
    Setting("tuned", 1e-12, tuned=True),
)


@cache
def table() -> dict[str, dict[str, Any]]:
    """The content of ``solvers.toml``: options and interfaces of each solver."""
    return tomllib.loads((Path(__file__).parent / "solvers.toml").read_text("utf-8"))


def known_to(door: str) -> list[str]:
    """Names that are understood behind ``qpsolvers:`` or ``cvxpy:``."""
    backends = [b.name for b in BACKENDS.values() if door == QPSOLVERS or b.cvxpy]
    return backends + [name for name, facts in table().items() if door in facts.get("doors", ())]


def installed_here(door: str) -> tuple[str, ...]:
    """Names of the solvers of an interface that are installed here."""
    others = [name for name in known_to(door) if name not in BACKENDS and find_spec(name)]
    return (*installed(door), *others)


@cache
def _version(package: str) -> str:
    return importlib.metadata.version(package)


@dataclass(frozen=True)
class Solver:
    """One solver of a study.

    Parameters
    ----------
    name : str
    door : str
        ``"qpsolvers"``, ``"cvxpy"`` or ``"function"``.
    target : str or bytes
        The solver's name there; or a function, pickled: see :func:`function_solver`.
    options : mapping of str to mapping
        Options of its own by setting, in place of ours.
    """

    name: str
    door: str
    target: Any
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """Door and name, unique in a study."""
        return f"{self.door}:{self.name}"

    @property
    def facts(self) -> dict[str, Any]:
        """The facts about the solver in the table of backends; empty for a function."""
        return {} if self.door == FUNCTION else table()[self.target]

    @property
    def version(self) -> str:
        """Version of the package that holds the solver; empty for a function."""
        known = BACKENDS.get(self.target)
        package = known.to_install if known else self.target
        return "" if self.door == FUNCTION else _version(package)

    def takes(self, setting: Setting) -> bool:
        """Whether a setting has a meaning for the solver."""
        return setting.name in self.options or setting.accuracy is None or "accuracy" in self.facts

    def asked(self, setting: Setting, seconds: float) -> tuple[Options, float | None]:
        """The solver's options for a setting, and the accuracy that they ask for.

        Parameters
        ----------
        setting : Setting
        seconds : float
            The time limit of a call [s].
        """
        if setting.name in self.options:
            return dict(self.options[setting.name]), setting.accuracy
        facts = self.facts
        limit: Options = {facts["time_limit"]: seconds} if "time_limit" in facts else {}
        limit |= facts.get("always", {})
        if setting.accuracy is None:
            return limit, None
        if setting.tuned and self.target in BACKENDS:
            (accuracy, options), *_ = BACKENDS[self.target].attempts(setting.accuracy)
            return options | limit, accuracy
        accuracy = max(setting.accuracy, facts.get("floor", 0.0))
        options = dict.fromkeys(facts["accuracy"], accuracy) | facts.get("others", {})
        refused = facts.get(self.door, {}).get("refused", ())
        taken = {option: value for option, value in options.items() if option not in refused}
        return limit | taken, accuracy


def function_solver(
    function: Callable[..., Any],
    name: str | None = None,
    *,
    options: Mapping[str, Mapping[str, Any]] | None = None,
) -> Solver:
    """A function as a solver of a study.

    Parameters
    ----------
    function : callable
        ``(P, q, G, h, **options) -> (x, z, status)``; of a problem with equations A x = b it gets A
        and b by name, and returns (x, z, y, status). One of a script goes to other processes by
        value, one of a module by its name.
    name : str, optional
        By default the function's own.
    options : mapping of str to mapping, optional
        What it is given at a setting, by the name of the setting.

    Raises
    ------
    InputError
        If it is not callable or cannot be pickled.
    """
    name = name or str(getattr(function, "__name__", type(function).__name__))
    if not callable(function):
        raise InputError("must be a function", field=name, value=function)
    cloudpickle = needed_package("cloudpickle", "study", "a solver of your own")
    try:
        target = cloudpickle.dumps(function)
    except Exception as error:  # whatever the things that it holds raise
        words = f"cannot be sent to another process: {error}"
        raise InputError(words[:200], field=name) from None
    return Solver(name, FUNCTION, target, options or {})


def solvers_of(wanted: Iterable[str | Callable[..., Any] | Solver]) -> list[Solver]:
    """Solvers by their names, and functions, each once.

    Raises
    ------
    InputError
        If a name is unknown, its solver is not installed, or two functions have one name.
    """
    chosen: dict[str, Solver] = {}
    for one in wanted:
        if isinstance(one, str):
            chosen |= {solver.label: solver for solver in solvers_named(one)}
            continue
        solver = one if isinstance(one, Solver) else function_solver(one)
        if solver.label in chosen:
            words = "stands twice; give one of them another name"
            raise InputError(words, field="solvers", value=solver.name)
        chosen[solver.label] = solver
    return list(chosen.values())


def settings_of(wanted: Iterable[str | Setting]) -> list[Setting]:
    """Settings by their names, and settings themselves, each once; InputError otherwise."""
    known = {setting.name: setting for setting in SETTINGS}
    chosen: dict[str, Setting] = {}
    for one in wanted:
        if isinstance(one, str) and one not in known:
            words = f"has an unknown name{suggestion(one, known)}"
            raise InputError(words, field="settings", value=one)
        setting = known[one] if isinstance(one, str) else one
        chosen[setting.name] = setting
    return list(chosen.values())


def solvers_named(name: str) -> list[Solver]:
    """The solver of ``door:name``, or all that are installed of ``door:*``.

    Raises
    ------
    InputError
        If a name is unknown, or its solver is not installed.
    """
    door, _, target = name.partition(":")
    if door not in BY_NAME:
        words = "is no solver: write qpsolvers:NAME or cvxpy:NAME, or give a function"
        raise InputError(words, field="solvers", value=name)
    names = installed_here(door) if target == "*" else (target,)
    for one in names:
        check_installed(door, one)
    return [Solver(one, door, one) for one in names]


def check_installed(door: str, name: str) -> None:
    """Refuse a solver that a door does not know, or that is not installed: InputError."""
    known = known_to(door)
    if name not in known:
        raise InputError(f"is no solver of {door}{suggestion(name, known)}", value=name)
    if name not in installed_here(door):
        entry = BACKENDS.get(name)
        remedy = entry.to_install_it if entry else f"pip install {name}"
        raise InputError(f"is not installed; {remedy}", value=name)
