"""Compiled functions in the place of NumPy's, each tried on fixed inputs before it is used."""

import sys
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from typing import Any, Final

from quasistatic_ref.optional.compiled.library import missing
from quasistatic_ref.text.plain import bits

LEAVES: Final[Mapping[str, str]] = {
    "Clouds.contacts": "points:contacts",
    "OnHalfSpaces.contacts": "points:on_planes",
    "Sums.plus": "sums:plus",
    "StepPlan.loads": "form_step:loads",
    "StepPlan.formed": "form_step:formed",
    "GroupIndex.write": "programs:write",
}
"""By a function, or a method, ``module:name`` of what stands in its place.

``name`` makes of an instance, or of None, a function with the same arguments, whose answer is None
where it declines; or None, if it knows nothing of this instance. ``trials_of_name`` are instances
that it knows, each with arguments; ``bits_of_`` the function's name gives what of an answer has
to be the same, if that is not what it compares."""


def compiled_function(function: Callable[..., Any], instance: Any) -> Callable[..., Any] | None:
    """The compiled twin of a function, or of an instance's method; None if there is none."""
    if not is_compiled(function):
        return None
    made: Callable[..., Any] | None = leaf(function)[0](instance)
    return made


def is_compiled(function: Callable[..., Any]) -> bool:
    """Whether compiled code stands in the place of a function."""
    return missing() is None and is_right(function)


def leaf(function: Callable[..., Any]) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """What makes the compiled twin of a function for an instance, and the inputs of its trials."""
    module, name = LEAVES[function.__qualname__].split(":")
    loaded = import_module(f"{__package__}.{module}")
    return getattr(loaded, name), getattr(loaded, f"trials_of_{name}")


@cache
def is_right(function: Callable[..., Any]) -> bool:
    """Whether compiled code has a function's bits on fixed inputs; it says if not."""
    of, trials = leaf(function)
    seen = getattr(import_module(trials.__module__), f"bits_of_{function.__name__}", bits)
    for instance, arguments in trials():
        by_c = of(instance)
        answer = by_c and by_c(*arguments)
        of_numpy = arguments if instance is None else (instance, *arguments)
        if answer is None or seen(answer) != seen(function(*of_numpy)):
            name = function.__qualname__
            print(f"compiled code is left out: {name} has other bits", file=sys.stderr)
            return False
    return True
