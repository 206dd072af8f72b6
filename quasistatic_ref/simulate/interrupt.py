"""What asks a run to end (Ctrl-C, SIGTERM, SIGHUP) is answered between two steps."""

import signal
import threading
from collections.abc import Callable
from types import FrameType

Handler = Callable[[int, FrameType | None], object] | int
ENDS: dict[signal.Signals, Handler] = {
    signal.SIGINT: signal.default_int_handler,  # Ctrl-C
    signal.SIGTERM: signal.SIG_DFL,  # what job schedulers send
    signal.SIGHUP: signal.SIG_DFL,  # a terminal that was closed
}
"""Signals that end a process, with the handlers that a fresh interpreter has for them."""


class Ended(KeyboardInterrupt):
    """A signal other than Ctrl-C ended a run.

    Parameters
    ----------
    number : int
        Of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(f"ended by {signal.Signals(number).name}")
        self.number = number


def exit_status(ended: KeyboardInterrupt) -> int:
    """The exit status of a process that Ctrl-C or another signal ends: 128 and its number."""
    return 128 + (ended.number if isinstance(ended, Ended) else signal.SIGINT)


class Interrupt:
    """Notes a signal that ends a process while it is open; a second one raises at once.

    An exception raised in the middle of a step could be swallowed by a solver's own handlers, or
    leave a step half recorded. A signal that has another handler, or none (``nohup``), keeps it;
    in another thread than the main one nothing is changed.
    """

    def __init__(self) -> None:
        self.noted: int | None = None
        self._signals: list[signal.Signals] = []

    def __enter__(self) -> "Interrupt":
        if threading.current_thread() is threading.main_thread():
            self._signals = [one for one, usual in ENDS.items() if signal.getsignal(one) is usual]
        for one in self._signals:
            signal.signal(one, self._note)
        return self

    def __exit__(self, *raised: object) -> None:
        for one in self._signals:
            signal.signal(one, ENDS[one])

    def _note(self, number: int, frame: FrameType | None) -> None:
        again = self.noted is not None
        self.noted = number
        if again:
            self.check()

    def check(self) -> None:
        """Raise KeyboardInterrupt, or `Ended`, if a signal was noted since the opening."""
        if self.noted == signal.SIGINT:
            raise KeyboardInterrupt
        if self.noted is not None:
            raise Ended(self.noted)
