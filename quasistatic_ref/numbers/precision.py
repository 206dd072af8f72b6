"""The precision of exact and ball arithmetic, which is FLINT's, one for all threads."""

from collections.abc import Iterator
from contextlib import contextmanager
from threading import RLock
from typing import Final

from flint import ctx

_TURN: Final = RLock()


@contextmanager
def working_precision(bits: int) -> Iterator[None]:
    """Compute with a number of bits, while other threads wait for their turn.

    FLINT has one precision for the whole process: a thread that changed it in the middle of
    another's sum would round what has to be exact.

    Parameters
    ----------
    bits : int
    """
    with _TURN:
        before = ctx.prec
        ctx.prec = bits
        try:
            yield
        finally:
            ctx.prec = before
