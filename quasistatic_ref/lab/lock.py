"""A folder that one process at a time writes into."""

from __future__ import annotations

import contextlib
import fcntl
import os
from pathlib import Path

from quasistatic_ref.errors import InputError


class Lock:
    """A folder that this object alone writes into, made if it is not there.

    The system holds it, and lets go when the process ends, however it ends: none is left behind.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    InputError
        If another sweep writes into it, or it cannot be made.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._descriptor: int | None = None
        while self._descriptor is None:
            try:
                folder.mkdir(parents=True, exist_ok=True)
                descriptor = os.open(folder, os.O_RDONLY)
            except OSError as error:
                reason = error.strerror or str(error)
                problem = f"cannot be written: {reason}; choose another folder"
                raise InputError(problem, file=folder.parent) from None
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                if os.path.samestat(os.fstat(descriptor), os.stat(folder)):
                    self._descriptor = descriptor
            except BlockingIOError:
                problem = "is being written by another sweep; wait for its end"
                raise InputError(problem, file=folder) from None
            except FileNotFoundError:
                pass  # the one before has just removed it
            finally:
                if self._descriptor is None:
                    os.close(descriptor)

    def release(self) -> None:
        """Let others write; an empty folder is removed."""
        if self._descriptor is not None:
            with contextlib.suppress(OSError):  # it holds files, or is gone
                self.folder.rmdir()
            os.close(self._descriptor)
            self._descriptor = None

    def __enter__(self) -> Lock:
        return self

    def __exit__(self, *exception: object) -> None:
        self.release()
