"""What a caller in Python gives: the keywords of a call, and the kinds of its objects."""

from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from inspect import signature
from typing import Any, ParamSpec, TypeVar

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion

P = ParamSpec("P")
T = TypeVar("T")
Made = TypeVar("Made", bound=type[Any])


def arguments_checked(function: Callable[P, T]) -> Callable[P, T]:
    """The same function; an InputError in place of Python's TypeError about its arguments."""

    @wraps(function)
    def checked(*arguments: P.args, **named: P.kwargs) -> T:
        try:
            return function(*arguments, **named)
        except TypeError:
            misfit = _misfit(function, arguments, named)
            if misfit is None:  # an error of something else
                raise
        raise misfit

    return checked


def made_by_arguments(made: Made) -> Made:
    """The same class, which checks the arguments that its objects are made with."""
    made.__init__ = arguments_checked(made.__init__)
    return made


def _misfit(
    function: Callable[..., object], arguments: Iterable[object], named: Mapping[str, object]
) -> InputError | None:
    known = [name for name in signature(function).parameters if name not in ("self", "cls")]
    for name, value in named.items():
        if name not in known:
            return InputError(
                f"is not an argument{suggestion(name, known)}", field=name, value=value
            )
    try:
        signature(function).bind(*arguments, **named)
    except TypeError as error:  # such as: missing a required argument: 'h'
        return InputError(f"{error}; the arguments are {', '.join(known)}")
    return None


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
