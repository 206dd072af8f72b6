"""The compiled library, which is called by cffi in its out-of-line mode, without a parser of C.

``declared.h`` has the functions, and ``declared.py`` is what cffi makes of it.
"""

import os
from collections.abc import Callable
from functools import cache
from typing import Any

from quasistatic_ref.optional.compiled.build import LIBRARY, PROBLEM, VARIABLE, digest

KEPT: list[Any] = []
"""Libraries that were loaded: when cffi lets one go, its functions lead nowhere."""


def missing() -> str | None:
    """Why no compiled code is used, in words; None if it is."""
    loaded = _loaded()
    return loaded if isinstance(loaded, str) else None


def function(name: str) -> Callable[..., int]:
    """A function of the library by its name, where nothing is :func:`missing`."""
    found: Callable[..., int] = getattr(_loaded(), name)
    return found


@cache
def _loaded() -> Any:
    if os.environ.get(VARIABLE) == "0":
        return f"{VARIABLE} is 0"
    if not LIBRARY.exists():
        why = PROBLEM.read_text("utf-8") if PROBLEM.exists() else "the package was copied"
        return f"it was not compiled when the package was installed: {why}"
    try:
        from quasistatic_ref.optional.compiled.declared import ffi  # not in a light installation

        library = ffi.dlopen(str(LIBRARY))
        KEPT.append(library)
        sources = ffi.string(library.digest()).decode()
    except (OSError, AttributeError) as failure:  # another machine's; without the function
        return f"it cannot be loaded: {failure}"
    except ImportError:
        return "cffi, which calls it, is not installed"
    if sources != digest():
        return "it was compiled from other sources than those here; install the package again"
    return library
