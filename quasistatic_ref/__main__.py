"""``python -m quasistatic_ref``: the command line, as ``quasistatic-ref``."""

import os
import signal
import sys
from types import FrameType
from typing import NoReturn


def main() -> int:
    """Run one command; Ctrl-C while its packages are imported ends the process with status 130.

    An exception would not do: some packages turn any exception into an ImportError of their own.
    """
    foreground = (
        signal.getsignal(signal.SIGINT) is signal.default_int_handler
    )  # not in the background
    if foreground:
        signal.signal(signal.SIGINT, _ended)
    from quasistatic_ref.cli.main import parsed, status

    options = parsed(sys.argv[1:])
    if foreground:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    return status(options)


def _ended(number: int, frame: FrameType | None) -> NoReturn:
    os.write(2, b"quasistatic-ref: interrupted\n")
    os._exit(130)


if __name__ == "__main__":
    sys.exit(main())
