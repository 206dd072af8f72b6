"""What solvers say when they begin: HiGHS greets, CVXPY logs which it cannot import."""

import ctypes
import logging
import os
import re
import sys
from functools import cache
from importlib import import_module

CANNOT_IMPORT = re.compile(r"Encountered unexpected exception importing solver (\w+)")
broken_solvers: dict[str, None] = {}
"""Those that CVXPY could not import, once it was imported itself."""


def _is_none_of_those(record: logging.LogRecord) -> bool:
    words = CANNOT_IMPORT.match(record.getMessage())
    if words is not None:
        broken_solvers[words[1].lower()] = None
    return words is None


logging.getLogger("__cvxpy__").addFilter(_is_none_of_those)


@cache
def greeting_silenced() -> None:
    """Discard what HiGHS prints when it starts."""
    highspy = import_module("highspy")
    sys.stdout.flush()
    try:
        kept = os.dup(1)
    except OSError:  # closed: there is nothing to disturb
        return
    null = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(null, 1)
        highspy.Highs()
        ctypes.CDLL(None).fflush(None)
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(null)
