"""Functions in whose place compiled ones stand, where ``optional/compiled`` is installed.

The NumPy function says what is computed: the compiled one has its arguments and its bits. What it
declines, such as a sign that stays open, NumPy computes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial, update_wrapper
from inspect import unwrap
from typing import Any, TypeVar, cast

from quasistatic_ref.parts import is_there, part

CompiledFunction = Callable[[Callable[..., Any], Any], Callable[..., Any] | None]
"""A function, and the instance of a method or None -> what stands in its place, if anything."""

IsCompiled = Callable[[Callable[..., Any]], bool]
"""A function -> whether compiled code stands in its place."""

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(by_numpy: Function) -> Function:
    """A function, or a method, that compiled code answers if it can; `by_numpy` else."""
    return cast(Function, _ByEither(by_numpy))


def is_compiled(function: Callable[..., Any]) -> bool:
    """Whether compiled code stands in the place of a function here."""
    if not is_there("is_compiled"):
        return False
    answer: IsCompiled = part("is_compiled")
    return answer(unwrap(function))


class _ByEither:
    """A function by NumPy, and the compiled one: of a method for each instance.

    Parameters
    ----------
    by_numpy : callable
        It is its ``__wrapped__``.
    """

    __wrapped__: Callable[..., Any]

    def __init__(self, by_numpy: Callable[..., Any]) -> None:
        update_wrapper(self, by_numpy)
        self._answer: Callable[..., Any] | None = None

    def __get__(self, instance: Any, owner: type) -> Any:
        if instance is None:
            return self
        answer = first_answer(self.__wrapped__, instance)
        instance.__dict__[self.__wrapped__.__name__] = answer  # found there from now on
        return answer

    def __call__(self, *arguments: Any) -> Any:
        if self._answer is None:
            self._answer = first_answer(self.__wrapped__)
        return self._answer(*arguments)


def first_answer(function: Callable[..., Any], instance: Any = None) -> Callable[..., Any]:
    """A function that asks C, and NumPy for what C declines; bound, where there is an instance."""
    by_numpy = function if instance is None else partial(function, instance)
    by_c: Callable[..., Any] | None = None
    if is_there("compiled_function"):
        compiled_function: CompiledFunction = part("compiled_function")
        by_c = compiled_function(function, instance)
    if by_c is None:
        return by_numpy

    def answer(*arguments: Any) -> Any:
        of_c = by_c(*arguments)
        return by_numpy(*arguments) if of_c is None else of_c

    return answer
