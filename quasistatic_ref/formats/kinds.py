"""What a caller in Python gives: the kinds of its objects."""

from collections.abc import Iterable
from typing import TypeVar

from quasistatic_ref.errors import InputError

T = TypeVar("T")


def check_kind(value: object, kind: type, field: str, remedy: str = "") -> None:
    """Refuse an object of another class: InputError, with a remedy after its problem."""
    if not isinstance(value, kind):
        raise InputError(f"must be a {kind.__name__}{remedy}", field=field, value=value)


def checked_items(values: object, kind: type[T], field: str) -> tuple[T, ...]:
    """A tuple of objects of one class; InputError of anything else, such as a single one."""
    if isinstance(values, str | kind) or not isinstance(values, Iterable):
        problem = f"must be a list of objects of class {kind.__name__}"
        raise InputError(problem, field=field, value=values)
    items = tuple(values)
    for i, item in enumerate(items):
        check_kind(item, kind, f"{field}[{i}]")
    return items
