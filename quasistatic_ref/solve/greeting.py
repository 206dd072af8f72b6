"""HiGHS greets on standard output, once a process, when its first object is made."""

import ctypes
import os
import sys
from functools import cache
from importlib import import_module


@cache
def greeting_silenced() -> None:
    """Let HiGHS greet where nobody reads it."""
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
