"""Files that are read together, as those of a scenario: each is read once."""

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar

T = TypeVar("T")

_READ: ContextVar[dict[Hashable, Any] | None] = ContextVar("what is read together", default=None)


@contextmanager
def together() -> Iterator[None]:
    """A context within which :func:`once` reads each file only once."""
    if _READ.get() is not None:
        yield
        return
    token = _READ.set({})
    try:
        yield
    finally:
        _READ.reset(token)


def once(key: Hashable, made: Callable[[], T]) -> T:
    """The value of ``made()``, computed once for each key within :func:`together`."""
    read = _READ.get()
    if read is None:
        return made()
    if key not in read:
        read[key] = made()
    content: T = read[key]
    return content
