"""The precision of exact and ball arithmetic, which is FLINT's, one for all threads."""

from threading import RLock
from typing import Final

from flint import ctx

_TURN: Final = RLock()


class working_precision:
    """Compute with a number of bits, while other threads wait for their turn.

    FLINT has one precision for the whole process: a thread that changed it in the middle of
    another's sum would round what has to be exact.

    Parameters
    ----------
    bits : int
    """

    __slots__ = ("before", "bits")

    def __init__(self, bits: int) -> None:
        self.bits = bits

    def __enter__(self) -> None:
        _TURN.acquire()
        self.before = ctx.prec
        ctx.prec = self.bits

    def __exit__(self, *exception: object) -> None:
        ctx.prec = self.before
        _TURN.release()
