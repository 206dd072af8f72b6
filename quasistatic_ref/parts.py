"""Access to the optional parts: a module of ``optional``, or None where its folder is missing.

The core imports no optional part. It asks for one here, under the word that users write.
"""

from functools import cache
from importlib import import_module
from types import ModuleType
from typing import Any

from quasistatic_ref.errors import InputError

OPTIONAL = "quasistatic_ref.optional"


@cache
def part(module: str) -> ModuleType | None:
    """A module of an optional part, such as ``"runs.resume"``; None where that part is missing."""
    try:
        return import_module(f"{OPTIONAL}.{module}")
    except ModuleNotFoundError as error:
        if error.name not in (OPTIONAL, _folder(module)):
            raise  # a package that the part itself needs
        return None


def needed_part(module: str, word: str) -> ModuleType:
    """The same for a word that means nothing without it, such as ``save``.

    Raises
    ------
    InputError
        If that part is missing.
    """
    found = part(module)
    if found is None:
        raise InputError(f"{word} needs {_folder(module).replace('.', '/')}")
    return found


def fast_part(module: str) -> ModuleType | None:
    """A module of ``optional/fast``, which means nothing without compiled code; None, and said.

    Raises
    ------
    InputError
        If that folder is missing.
    """
    usable = needed_part("fast.speed", "fast").usable()
    return needed_part(f"fast.{module}", "fast") if usable else None


def needed_package(package: str, extra: str, what: str) -> Any:
    """A package that an extra of the installation brings.

    Parameters
    ----------
    package, extra : str
    what : str
        What needs it, for the message.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        return import_module(package)
    except ImportError:
        problem = f"{what} needs {package}: pip install 'quasistatic-ref[{extra}]'"
        raise InputError(problem) from None


def _folder(module: str) -> str:
    return f"{OPTIONAL}.{module.partition('.')[0]}"
