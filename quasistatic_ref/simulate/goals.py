"""Targets and forces in any form that a user may give them, as checked functions of (t, q)."""

from collections.abc import Callable
from inspect import Parameter, signature
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError
from quasistatic_ref.model.system import System
from quasistatic_ref.step.data import Array

OfTime = Callable[[float], ArrayLike]
OfTimeAndQ = Callable[[float, Array], ArrayLike]
Checked = Callable[[float, Array], Array]
"""A function of (t, q) whose results have the right shape."""
Target = OfTime | OfTimeAndQ | ArrayLike
Force = OfTime | OfTimeAndQ
NAMED = (Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD)
ANY_NUMBER = (Parameter.VAR_POSITIONAL, Parameter.VAR_KEYWORD)


def target_function(system: System, h: float, target: Target, steps: int) -> Checked:
    """Targets in any accepted form as a function of (t, q); every value is checked like a q.

    Parameters
    ----------
    system : System
    h : float
        Time step [s].
    target : callable, or ndarray of shape (n_q_a,) or (steps, n_q_a)
        q_bar_a [m, rad, -] as a function of t [s] or of (t, q), constant, or step by step.
    steps : int

    Raises
    ------
    InputError
        If it takes other arguments, has or returns another shape, or a number is not finite.
    """
    n = system.n_q_a

    def checked(q_a: Array) -> Array:
        return system.checked(system.with_actuated(system.q_start, q_a))[:n]

    if callable(target):
        goal = _returning(of_time_and_q(target, "target"), (n,), "target")
        return lambda t, q: checked(goal(t, q))
    values = np.asarray(target, dtype=np.float64)
    if values.shape not in {(n,), (steps, n)} or not np.isfinite(values).all():
        problem = f"must contain finite numbers of shape ({n},) or ({steps}, {n})"
        raise InputError(problem, field="target", value=values.shape)
    if values.ndim == 1:
        constant = checked(values)
        return lambda t, q: constant
    table = [checked(row) for row in values]
    return lambda t, q: table[round(t / h) - 1]


def force_function(system: System, force: Force | None) -> Checked:
    """An external force as a function of (t, q), shape (n_v,) [N, N m]; zero where it is None.

    Raises
    ------
    InputError
        If it takes other arguments, or returns another shape.
    """
    if force is None:
        nothing = np.zeros(system.n_v)
        return lambda t, q: nothing
    return _returning(of_time_and_q(force, "force"), (system.n_v,), "force")


def of_time_and_q(function: Callable[..., Any], name: str) -> OfTimeAndQ:
    """A function of t or of (t, q), as one of (t, q); its result keeps its shape.

    The arguments without defaults decide which of both it is; the others keep their defaults.

    Parameters
    ----------
    function : callable
    name : str
        What to call it in messages.

    Raises
    ------
    InputError
        If it takes other arguments.
    """
    try:
        parameters = list(signature(function).parameters.values())
    except (TypeError, ValueError):  # compiled, and without a signature
        return lambda t, q: function(t)
    needed = [p for p in parameters if p.default is p.empty and p.kind not in ANY_NUMBER]
    names = [p.name for p in parameters if p.kind in NAMED]
    if names and names[0] != "q" and all(p.kind in NAMED for p in needed):
        if len(needed) == 2:
            return function
        if len(needed) < 2:
            return lambda t, q: function(t)
    written = str(signature(function)).partition(" ->")[0]
    raise InputError("must be a function of t, or of (t, q)", field=name, value=written)


def _returning(function: OfTimeAndQ, shape: tuple[int, ...], name: str) -> Checked:
    """The same function, its results as arrays of one shape."""

    def value(t: float, q: Array) -> Array:
        returned = function(t, q)
        try:
            array = np.asarray(returned, dtype=np.float64)
        except (TypeError, ValueError):
            array = np.asarray(np.nan)
        if array.shape != shape:
            raise InputError(f"must return numbers of shape {shape}", field=name, value=returned)
        return array

    return value
