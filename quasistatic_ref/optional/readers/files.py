"""What readers of files share: the sentence of what a library cannot read, and a bound."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from quasistatic_ref.errors import InputError, ModelError

LARGEST_UNPACKED: Final = 64 * 2**20
"""Largest sum of what a file holds compressed, or of its arrays [bytes]."""


@contextmanager
def malformed(kind: str) -> Iterator[None]:
    """A context that turns a library's error while reading a file into a ModelError.

    Raises
    ------
    ModelError
        If it raises something else: each library has its own kinds of errors, in its own words.
    """
    try:
        yield
    except InputError:
        raise
    except Exception:
        problem = f"cannot be read as {kind}: it is malformed; export it again"
        raise ModelError(problem) from None


def check_unpacked(size: int) -> None:
    """ModelError if a file states that it unpacks to more bytes than it may."""
    if size > LARGEST_UNPACKED:
        most = LARGEST_UNPACKED / 2**20
        raise ModelError(f"unpacks to more than {most:g} MiB", value=size)
