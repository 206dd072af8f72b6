"""A process that is watched: it runs in a session of its own, and ends with all that it started."""

import contextlib
import os
import signal
import subprocess
import uuid
from collections.abc import Mapping, Sequence

from quasistatic_ref.lab import processes


class Supervised:
    """A process of a program that may crash, hang, eat memory, or leave others behind.

    Parameters
    ----------
    words : sequence of str
        The command with its arguments.
    pipe : int
        For its standard input, output and error: ``subprocess.PIPE`` or ``subprocess.DEVNULL``.
    variables : mapping of str to str
        Of the environment, in addition to those of this process.
    descriptors : sequence of int
        Open files that it inherits.

    Raises
    ------
    OSError
        If it cannot be started.
    """

    def __init__(
        self,
        words: Sequence[str],
        pipe: int = subprocess.DEVNULL,
        variables: Mapping[str, str] | None = None,
        descriptors: Sequence[int] = (),
    ) -> None:
        self._token = uuid.uuid4().hex
        self.process = subprocess.Popen(
            words,
            stdin=pipe,
            stdout=pipe,
            stderr=pipe,
            pass_fds=descriptors,
            env={**os.environ, **(variables or {}), processes.TOKEN: self._token},
            start_new_session=True,
        )
        self.pid = self.process.pid

    def status(self, patience: float = 1.0) -> int | None:
        """Its exit status, negative where a signal ended it; None if it still runs after a while.

        Parameters
        ----------
        patience : float
            How long its end is waited for [s].
        """
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.process.wait(timeout=patience)
        return self.process.poll()

    def tidy(self) -> None:
        """End what has detached itself from it."""
        processes.end(processes.detached_processes(self.pid))

    def end(self) -> None:
        """End it, its children, and what they left behind."""
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.kill(self.pid, signal.SIGSTOP)  # it starts no more of them
        processes.end(processes.descendants(self.pid))
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(self.pid, signal.SIGKILL)
        self.process.wait()
        processes.end(processes.marked_processes(self._token))
