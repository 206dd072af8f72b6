"""A folder that one process at a time writes into."""

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.text.content import writable_folder


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other studies and sweeps from writing into a folder, which is made if it is not there.

    The system holds the lock, and lets go when the process ends, however it ends.

    Raises
    ------
    InputError
        If another one writes into the folder, or it cannot be made.
    """
    descriptor = os.open(writable_folder(folder), os.O_RDONLY)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            problem = "is being written by another process; wait for its end"
            raise InputError(problem, file=folder) from None
        yield
    finally:
        os.close(descriptor)
