"""Methods in whose place compiled functions stand, where ``optional/compiled`` is installed.

The NumPy function says what is computed: the compiled one has its arguments and its bits. What it
declines, such as a sign that stays open, NumPy computes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

from quasistatic_ref.parts import is_there, part

CompiledMethod = Callable[[str, Any], Callable[..., Any] | None]
"""A word, ``Class.method``, and an instance -> the compiled function in its place, if any."""

Method = TypeVar("Method", bound=Callable[..., Any])


def compiled(by_numpy: Method) -> Method:
    """A method that each instance takes from compiled code, if that has it; `by_numpy` else."""
    return cast(Method, _Method(by_numpy))


class _Method:
    """A method by NumPy, and for each instance that calls it the compiled one.

    Parameters
    ----------
    by_numpy : callable
    """

    def __init__(self, by_numpy: Callable[..., Any]) -> None:
        self.by_numpy = by_numpy
        self.__doc__ = by_numpy.__doc__

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name
        self._word = f"{owner.__name__}.{name}"

    def __get__(self, instance: Any, owner: type) -> Any:
        if instance is None:
            return self
        by_numpy = self.by_numpy.__get__(instance, owner)
        by_c: Callable[..., Any] | None = None
        if is_there("compiled_method"):
            compiled_method: CompiledMethod = part("compiled_method")
            by_c = compiled_method(self._word, instance)
        method = _first_answer(by_c, by_numpy) if by_c else by_numpy
        instance.__dict__[self._name] = method  # found there from now on
        return method


def _first_answer(by_c: Callable[..., Any], by_numpy: Callable[..., Any]) -> Callable[..., Any]:
    """A function that asks C, and NumPy for what C declines."""

    def answer(*arguments: Any) -> Any:
        of_c = by_c(*arguments)
        return by_numpy(*arguments) if of_c is None else of_c

    return answer
