"""The door to compiled code: a module of ``fast``, or nothing where it cannot be compiled.

Whatever comes through it is equal to the last bit to what NumPy and python-flint give without it.
"""

from functools import cache
from types import ModuleType

from quasistatic_ref.parts import part


@cache
def compiled(name: str) -> ModuleType | None:
    """A module of ``fast/compiled`` by its name, or None: :func:`why_not` says why."""
    return part(f"fast.compiled.{name}") if why_not() is None else None


@cache
def why_not() -> str | None:
    """Why nothing is compiled here, in words; None if it is."""
    library = part("fast.compiled.library")
    if library is None:
        return "quasistatic_ref/optional/fast is missing"
    reason: str | None = library.why_not()
    return reason
