"""The solvers of a study, by the door through which they are called, and their settings."""

import importlib.metadata
import inspect
import tomllib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.lab.study.promises import RESIDUALS, Promise, promise_stated, resolved
from quasistatic_ref.parts import needed_package
from quasistatic_ref.solve.backends import BACKENDS, Options, installed

QPSOLVERS, CVXPY, FUNCTION = DOORS = ("qpsolvers", "cvxpy", "function")
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
    """What ``solvers.toml`` knows of each solver."""
    return tomllib.loads((Path(__file__).parent / "solvers.toml").read_text("utf-8"))


def known_to(door: str) -> list[str]:
    """Names that are understood behind ``qpsolvers:`` or ``cvxpy:``."""
    backends = [b.name for b in BACKENDS.values() if door == QPSOLVERS or b.cvxpy]
    return backends + [name for name, facts in table().items() if door in facts.get("doors", ())]


def installed_here(door: str) -> tuple[str, ...]:
    """Those of them that are installed."""
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
        One of ``DOORS``.
    target : str or bytes
        The solver's name there; or a function, pickled: see :func:`function_solver`.
    options : mapping of str to mapping
        Options of its own by setting, in place of ours.
    promised : mapping of str to mapping
        By setting, what its author promises of residuals, as in ``promises.py``.
    starts : bool
        Whether a function takes ``start=(x, z)``.
    """

    name: str
    door: str
    target: Any
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    promised: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    starts: bool = False

    @property
    def label(self) -> str:
        """Door and name, unique in a study."""
        return f"{self.door}:{self.name}"

    @property
    def facts(self) -> dict[str, Any]:
        """What the table knows of it: nothing of a function."""
        return {} if self.door == FUNCTION else table()[self.target]

    @property
    def version(self) -> str:
        """Of the package that it comes in; "" of a function."""
        known = BACKENDS.get(self.target)
        package = known.to_install if known else self.target
        return "" if self.door == FUNCTION else _version(package)

    @property
    def warm(self) -> bool:
        """Whether its door, or its function, uses a start."""
        if self.door == FUNCTION:
            return self.starts
        return self.door in self.facts.get("warm", ())

    def takes(self, setting: Setting) -> bool:
        """Whether a setting means anything to it."""
        return setting.name in self.options or setting.accuracy is None or "accuracy" in self.facts

    def settings_of(self, setting: Setting, seconds: float) -> Options:
        """The options that a setting is to this solver.

        Parameters
        ----------
        setting : Setting
        seconds : float
            The time limit of a problem [s].
        """
        if setting.name in self.options:
            return dict(self.options[setting.name])
        facts = self.facts
        limit: Options = {facts["time_limit"]: seconds} if "time_limit" in facts else {}
        limit |= facts.get("always", {})
        if setting.accuracy is None or "accuracy" not in facts:
            return limit
        if setting.tuned and self.target in BACKENDS:
            (_, options), *_ = BACKENDS[self.target].attempts(setting.accuracy)
            return options | limit
        return limit | self._options_at(setting)

    def _options_at(self, setting: Setting) -> Options:
        """The plain options of an accuracy."""
        facts = self.facts
        accuracy = max(setting.accuracy or 0.0, facts.get("floor", 0.0))
        options: Options = dict.fromkeys(facts["accuracy"], accuracy) | facts.get("others", {})
        refused = facts.get(self.door, {}).get("refused", ())
        return {option: value for option, value in options.items() if option not in refused}

    def promise(self, setting: Setting, options: Options) -> Promise:
        """What its "optimal" promises of residuals at a setting, with the options that it got.

        It is what its author says, else what its documentation says of its options; of a function
        whose author says nothing, the accuracy.
        """
        if setting.name in self.promised:
            return resolved(self.promised[setting.name], options)
        if self.door == FUNCTION:
            every = {} if setting.accuracy is None else dict.fromkeys(RESIDUALS, setting.accuracy)
            return resolved(every, {})
        facts = self.facts
        here = facts.get(self.door, {})
        stated = here.get("promise", facts.get("promise", {}))
        return resolved(stated, facts.get("defaults", {}) | here.get("defaults", {}) | options)


def function_solver(
    function: Callable[..., Any],
    name: str | None = None,
    *,
    options: Mapping[str, Mapping[str, Any]] | None = None,
    promised: Mapping[str, Mapping[str, Any]] | None = None,
) -> Solver:
    """A function as a solver of a study.

    Parameters
    ----------
    function : callable
        ``(P, q, G, h, **options) -> (x, z, status)``. One of a script goes to other processes by
        value, one of a module by its name.
    name : str, optional
        By default the function's own.
    options : mapping of str to mapping, optional
        What it is given at a setting, by the name of the setting.
    promised : mapping of str to mapping, optional
        By setting, what "optimal" promises of residuals: primal, dual and gap, each a number or a
        table of abs, rel and of. By default the accuracy of the setting.

    Raises
    ------
    InputError
        If it is not callable or cannot be pickled, or a promise is none.
    """
    name = name or str(getattr(function, "__name__", type(function).__name__))
    if not callable(function):
        raise InputError("is not a function", field=name, value=function)
    for setting, value in (promised or {}).items():
        try:
            promise_stated(value)
        except (ValueError, TypeError, KeyError, AttributeError) as error:
            words = "must be a table of primal, dual and gap, each a number or a table of abs, rel"
            where = f"{name}: promised.{setting}"
            raise InputError(f"{words} and of: {error}", field=where, value=value) from None
    cloudpickle = needed_package("cloudpickle", "study", "a solver of your own")
    try:
        target = cloudpickle.dumps(function)
    except Exception as error:  # whatever the things that it holds raise
        words = f"cannot be sent to another process: {error}"
        raise InputError(words[:200], field=name) from None
    return Solver(name, FUNCTION, target, options or {}, promised or {}, takes_start(function))


def takes_start(function: Callable[..., Any]) -> bool:
    """Whether a function takes ``start=(x, z)``; a compiled one may not say what it takes."""
    try:
        return "start" in inspect.signature(function).parameters
    except ValueError:
        return False


def solvers_of(wanted: Iterable[str | Callable[..., Any] | Solver]) -> list[Solver]:
    """Solvers by their names, functions and solvers, each once.

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
    """Settings by their names, and others, each once; InputError if a name is unknown."""
    known = {setting.name: setting for setting in SETTINGS}
    chosen: dict[str, Setting] = {}
    for one in wanted:
        if isinstance(one, str) and one not in known:
            words = f"holds an unknown one{suggestion(one, known)}"
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
