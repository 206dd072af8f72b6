"""Solvers that installed packages announce, by an entry point that names a function.

A package needs to import nothing of this one. In its ``pyproject.toml`` it says::

    [project.entry-points."quasistatic_ref.solvers"]
    mine = "my_package.qp:solve"

and a study names it ``package:mine``.
"""

from collections.abc import Callable
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion

GROUP = "quasistatic_ref.solvers"


def announced_solvers() -> dict[str, list[EntryPoint]]:
    """What installed packages announce, by name; more than one under a name that is not clear."""
    found: dict[str, list[EntryPoint]] = {}
    for one in entry_points(group=GROUP):
        own = found.setdefault(one.name, [])
        if one not in own:
            own.append(one)
    return dict(sorted(found.items()))


def entry_of(name: str) -> EntryPoint:
    """The entry point of a name; nothing is imported.

    Raises
    ------
    InputError
        If no package announces it, or several packages do.
    """
    every = announced_solvers()
    if name not in every:
        words = f"is announced by no package, as an entry point of the group {GROUP!r}"
        raise InputError(f"{words}{suggestion(name, every)}", value=name)
    if len(every[name]) > 1:
        packages = " and ".join(f"{package_of(one)} ({one.value})" for one in every[name])
        raise InputError(f"is announced by several packages, {packages}; keep one", value=name)
    return every[name][0]


def package_of(entry: EntryPoint) -> str:
    """The name of the package that announces it."""
    return entry.dist.name if entry.dist else "a package without a name"


def function_at(target: str) -> Callable[..., Any]:
    """The function of ``module:function``.

    Raises
    ------
    InputError
        If there is none, or it cannot be imported.
    """
    try:
        function: Callable[..., Any] = EntryPoint("", target, GROUP).load()
    except Exception as error:  # a module may raise anything when it is imported
        words = f"cannot be imported: {type(error).__name__}: {error}"
        raise InputError(words, value=target) from None
    if not callable(function):
        raise InputError("is not a function", value=target)
    return function


def announced_function(name: str) -> Callable[..., Any]:
    """The function that a package announces.

    Raises
    ------
    InputError
        If there is none, or it cannot be imported.
    """
    entry = entry_of(name)
    try:
        return function_at(entry.value)
    except InputError as error:
        words = f"{entry.value} of {package_of(entry)}, {error.problem}"
        raise InputError(words, value=name) from None
