"""What optional parts answer: a function for each word that users write and that needs one.

The core names ``optional`` in this folder, and in ``contact`` for pairs of curved solids: in
functions, so that a part is imported when its word is used. Where its folder is missing, a word
that means nothing without it is refused in a sentence. A file of this folder is imported by the
folder of the core that it is called after, and by those above that: so types make no circle.
"""

from __future__ import annotations

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


def check_there(part: str, word: str) -> None:
    """Refuse a word whose part is missing, before the work in which it is used: InputError."""
    with needing(word):
        import_module(f"{OPTIONAL}.{part}")


def is_there(part: str) -> bool:
    """Whether the folder of a part is there, for what is done without it, too."""
    try:
        import_module(f"{OPTIONAL}.{part}")
    except ModuleNotFoundError as error:
        _missing_part(error)
        return False
    return True


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
