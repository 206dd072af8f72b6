"""Ctrl-C while a run goes on: answered between two steps, so that what was done is whole."""

import signal
import threading
from types import FrameType


class Interrupt:
    """Notes a Ctrl-C while it is open; a second one raises KeyboardInterrupt at once.

    An exception raised in the middle of a step could be swallowed by a solver's own handlers, or
    leave a step half recorded. Where another handler of Ctrl-C is installed, or this is not the
    main thread, nothing is changed.
    """

    def __init__(self) -> None:
        self.noted = False
        self._notes = False

    def __enter__(self) -> "Interrupt":
        here = threading.current_thread() is threading.main_thread()
        if here and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            signal.signal(signal.SIGINT, self._note)
            self._notes = True
        return self

    def __exit__(self, *raised: object) -> None:
        if self._notes:
            signal.signal(signal.SIGINT, signal.default_int_handler)

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self.noted:
            raise KeyboardInterrupt
        self.noted = True

    def check(self) -> None:
        """Raise KeyboardInterrupt if Ctrl-C was pressed since this object was opened."""
        if self.noted:
            raise KeyboardInterrupt
