"""A limit of the time that an exact answer may take, in a thread."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic

from quasistatic_ref.errors import QuasistaticError


class TimeIsUp(QuasistaticError):
    """An exact answer takes longer than it may, which says nothing of the program.

    Parameters
    ----------
    seconds : float
        The limit [s].

    Examples
    --------
    >>> str(qr.TimeIsUp(60.0))
    'not ended in 60 s'
    """

    def __init__(self, seconds: float) -> None:
        super().__init__(f"not ended in {seconds:g} s")
        self.seconds = seconds


class _Limits(threading.local):
    """The end of each thread, on the monotonic clock [s], and the seconds to it from its start."""

    end = math.inf
    seconds = math.inf


_LIMITS = _Limits()


@contextmanager
def time_limit(seconds: float | None) -> Iterator[None]:
    """What is done inside ends with TimeIsUp after `seconds` [s]; None is no limit, nor a new one.

    An elimination, or another's solver, that has begun ends first.
    """
    if seconds is None:
        yield
        return
    before = _LIMITS.end, _LIMITS.seconds
    _LIMITS.end, _LIMITS.seconds = monotonic() + seconds, seconds
    try:
        yield
    finally:
        _LIMITS.end, _LIMITS.seconds = before


def check_time() -> None:
    """TimeIsUp, if it is."""
    if _LIMITS.end < math.inf and monotonic() > _LIMITS.end:
        raise TimeIsUp(_LIMITS.seconds)


def time_left() -> float:
    """How much there is [s]: more than zero, infinite without a limit."""
    check_time()
    return _LIMITS.end - monotonic()
