"""The door to `optional/fast`: the same steps in less time.

Nothing else in the core names that folder, and it is asked once: where a simulator or a solver is
made with ``fast``. Wherever an answer is certified exactly, it has the same bits either way.
"""

from importlib import import_module
from types import ModuleType

from quasistatic_ref.errors import InputError

_FOLDER = "quasistatic_ref.optional.fast"


def fast_module(name: str) -> ModuleType:
    """A module of `optional/fast` by its name.

    Raises
    ------
    InputError
        If that folder is not there.
    """
    try:
        return import_module(f"{_FOLDER}.{name}")
    except ModuleNotFoundError as missing:
        if missing.name != _FOLDER:
            raise
        raise InputError("needs quasistatic_ref/optional/fast", field="fast") from None
