"""The same steps in compiled code: optional, equal to the last bit; nobody needs to read it.

Whatever comes from here is equal to the last bit to what NumPy and python-flint give without it.
"""

from functools import cache
from importlib import import_module
from types import ModuleType


@cache
def compiled(name: str) -> ModuleType | None:
    """A module of this folder by its name, or None: :func:`why_not` says why."""
    return import_module(f"{__name__}.{name}") if why_not() is None else None


@cache
def why_not() -> str | None:
    """Why nothing is compiled here, in words; None if it is."""
    reason: str | None = import_module(f"{__name__}.library").why_not()
    return reason
