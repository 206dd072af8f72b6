"""What readers of files share: the sentence of what a library cannot read, and a bound."""

import struct
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from quasistatic_ref.errors import InputError, ModelError

LARGEST_UNPACKED: Final = 64 * 2**20
"""Largest sum of what a file holds compressed, or of its arrays [bytes]."""
SPOILT: Final[tuple[type[Exception], ...]] = (
    *(ValueError, TypeError, LookupError, AttributeError, ArithmeticError, AssertionError),
    *(RuntimeError, EOFError, StopIteration, struct.error),
)
"""What libraries raise at a file that is not as they expect."""


@contextmanager
def malformed(kind: str, *errors: type[Exception]) -> Iterator[None]:
    """A context that turns a library's error while reading a file into a ModelError.

    Its warnings are about its own code, not about the file, and are set aside. What says nothing
    of the file, such as a MemoryError or a package that cannot be imported, passes.

    Parameters
    ----------
    kind : str
    *errors : type
        The library's own, besides SPOILT.

    Raises
    ------
    ModelError
        If it raises one of these, in its own words.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except InputError:
        raise
    except (*SPOILT, *errors):
        problem = f"cannot be read as {kind}: it is malformed; export it again"
        raise ModelError(problem) from None


def check_unpacked(size: int) -> None:
    """ModelError if a file states that it unpacks to more bytes than it may."""
    if size > LARGEST_UNPACKED:
        most = LARGEST_UNPACKED / 2**20
        raise ModelError(f"unpacks to more than {most:g} MiB", value=size)
