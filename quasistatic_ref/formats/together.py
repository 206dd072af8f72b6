"""What files that are read together may take in all: a scenario may name many large ones."""

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any, TypeVar

SECONDS = 8.0
"""What they may take of an ordinary processor [s]; each reader says what its files take."""

T = TypeVar("T")


@dataclass
class Together:
    """Files that are read together.

    Parameters
    ----------
    seconds : float
        What those take that were read so far [s].
    kept : dict
        What was made of those that may be named again.
    """

    seconds: float = 0.0
    kept: dict[Hashable, Any] = field(default_factory=dict)


_READ: ContextVar[Together | None] = ContextVar("files that are read together", default=None)


@contextmanager
def together() -> Iterator[None]:
    """Within it, and within those inside of it, files are counted as read together."""
    if _READ.get() is not None:
        yield
        return
    token = _READ.set(Together())
    try:
        yield
    finally:
        _READ.reset(token)


def once(key: Hashable, made: Callable[[], T]) -> T:
    """What is made of a file, of which the key is the name: once for all that are read together."""
    read = _READ.get() or Together()
    if key not in read.kept:
        read.kept[key] = made()
    content: T = read.kept[key]
    return content
