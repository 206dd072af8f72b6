"""The door to compiled code: a module of ``fast``, or nothing where it cannot be compiled.

Whatever comes through it is equal to the last bit to what NumPy and python-flint give without it,
and nothing else in the package names that room.
"""

from functools import cache
from importlib import import_module
from types import ModuleType

_ROOM = "quasistatic_ref.optional.fast.compiled"


@cache
def compiled(name: str) -> ModuleType | None:
    """A module of ``fast`` by its name, or None: :func:`why_not` says why."""
    return import_module(f"{_ROOM}.{name}") if why_not() is None else None


@cache
def why_not() -> str | None:
    """Why nothing is compiled here, in words; None if it is."""
    reason: str | None = import_module(f"{_ROOM}.library").why_not()
    return reason
