"""Access to the optional parts, of which the core imports none but in the functions that need it.

There the import stands below ``with needing(...)``, for a word that means nothing without its part,
or below ``with if_there():``, for what the core does without it, too.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType

from quasistatic_ref.errors import InputError

OPTIONAL = "quasistatic_ref.optional"


@contextmanager
def needing(word: str) -> Iterator[None]:
    """Around imports of an optional part, for a word that means nothing without it.

    Raises
    ------
    InputError
        If its folder is missing, or all of ``optional/``, which is then named.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        name = _missing_part(error)
        problem = f"{word} needs {name.replace('.', '/')}"
        raise InputError(problem) from None


@contextmanager
def if_there() -> Iterator[None]:
    """Around imports of an optional part, and what is done with it where its folder is there."""
    try:
        yield
    except ModuleNotFoundError as error:
        _missing_part(error)


def needed_package(package: str, extra: str, what: str) -> ModuleType:
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


def _missing_part(error: ModuleNotFoundError) -> str:
    """The folder of a part that is missing; the error itself where something else is."""
    name = str(error.name)
    if not (name.startswith(OPTIONAL) and name.count(".") <= 2):
        raise error
    return name
