"""Access to the optional parts, of which the core imports none.

Where the core calls a part, it declares a :class:`Slot` with the type of what it calls. The part's
module fills the slot, and a type checker compares the two.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Generic, TypeVar

from quasistatic_ref.errors import InputError

OPTIONAL = "quasistatic_ref.optional"
T = TypeVar("T")


class Slot(Generic[T]):
    """A place of the core for what an optional part adds: a function, a class or an object.

    Parameters
    ----------
    module : str
        The module that fills it, such as ``"doctor.observer"``: imported when it is asked for.
    """

    def __init__(self, module: str) -> None:
        self.module = module
        self._filling: T | None = None

    @property
    def folder(self) -> str:
        """The folder of the part."""
        return f"{OPTIONAL}.{self.module.partition('.')[0]}"

    def fill(self, filling: T) -> None:
        """Put something there, as the last thing that the module does."""
        self._filling = filling

    def found(self) -> T | None:
        """What is there; None where the folder of the part is missing."""
        try:
            import_module(f"{OPTIONAL}.{self.module}")
        except ModuleNotFoundError as error:
            if error.name not in (OPTIONAL, self.folder):
                raise  # a package that the part itself needs
            return None
        return self._filling

    def needed(self, word: str) -> T:
        """The same for a word that means nothing without it, such as ``save``.

        Raises
        ------
        InputError
            If the folder is missing.
        """
        found = self.found()
        if found is None:
            raise InputError(_needs(word, self.folder))
        return found


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
        name = str(error.name)
        if not (name.startswith(OPTIONAL) and name.count(".") <= 2):
            raise
        raise InputError(_needs(word, name)) from None


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


def _needs(word: str, folder: str) -> str:
    return f"{word} needs {folder.replace('.', '/')}"
