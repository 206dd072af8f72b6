"""Targets and forces in any form that a user may give them, as checked functions.

They are functions of the time, of where the step starts, and of the result of the step before.
"""

from collections.abc import Callable, Mapping
from inspect import Parameter, signature

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError
from quasistatic_ref.model.configuration import surely_configurations
from quasistatic_ref.model.named import Values
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, checked_numbers, read_only
from quasistatic_ref.quoting import known_names
from quasistatic_ref.simulate.form_step import FROM_LOADS, checked_force
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.target import Targets

Value = ArrayLike | Values
OfTime = Callable[[float], Value]
OfTimeAndQ = Callable[[float, Array], Value]
OfTimeQAndLast = Callable[[float, Array, StepResult | None], Value]
Checked = Callable[[float, Array, StepResult | None], Array]
"""A function of (t, q, last) whose results have the right shape."""
Target = OfTime | OfTimeAndQ | OfTimeQAndLast | Value
Force = OfTime | OfTimeAndQ | OfTimeQAndLast | ArrayLike
NAMED = (Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD)
ANY_NUMBER = (Parameter.VAR_POSITIONAL, Parameter.VAR_KEYWORD)


def target_function(system: System, h: float, target: Target, steps: int) -> Checked:
    """Targets in any accepted form as a function of (t, q, last); every value is checked like a q.

    Parameters
    ----------
    system : System
    h : float
        Time step [s].
    target : callable, ndarray of shape (n_q_a,) or (steps, n_q_a), or mapping
        q_bar_a [m, rad, -] as a function of t [s], of (t, q) or of (t, q, last), constant, or step
        by step. A mapping, which a function may return, too, names actuated joints, and bodies
        with a base, as :meth:`~quasistatic_ref.model.system.System.placed` does; the others keep
        their targets of the start.
    steps : int

    Raises
    ------
    InputError
        If it takes other arguments, has or returns another shape, or a number is not finite.
    """
    n = system.n_q_a

    def checked(q_a: Array) -> Array:
        return system.checked(system.with_actuated(system.q_start, q_a))[:n]

    def unnamed(target_value: Value) -> object:
        return (
            named_target(system, target_value)
            if isinstance(target_value, Mapping)
            else target_value
        )

    if isinstance(target, Targets):
        target = target.over(np.arange(1.0, steps + 1.0) * h)
    if callable(target):
        goal = _returning(with_all_arguments(target, "target"), unnamed, (n,), "target")
        return lambda t, q, last: checked(goal(t, q, last))
    values = checked_numbers(unnamed(target), "target", InputError)
    if values.shape not in {(n,), (steps, n)} or not np.isfinite(values).all():
        problem = f"must contain finite numbers of shape ({n},) or ({steps}, {n}), or name joints"
        problem += f": {known_names(joint.name for joint in system.joints if joint.actuated)}"
        raise InputError(problem, field="target", value=values.shape)
    if values.ndim == 1:
        constant = checked(values)
        return lambda t, q, last: constant
    sure = surely_configurations(system.actuated, values)
    table = read_only(values + 0.0) if sure else [checked(row) for row in values]
    return lambda t, q, last: np.asarray(table[round(t / h) - 1])


def named_target(system: System, values: Values) -> Array:
    """q_bar_a, shape (n_q_a,), of named joints; InputError if one of them is not actuated."""
    for name, value in values.items():
        if (system.named.q(name) >= system.n_q_a).any():
            problem = "is not actuated; make it so where the body is made, by actuated=[...]"
            raise InputError(problem, field=f"target[{name}]", value=value)
    return system.placed(values)[: system.n_q_a]


def force_function(system: System, force: Force | None) -> Checked:
    """An external force as a function of (t, q, last), shape (n_v,) [N, N m]; zero where None.

    Raises
    ------
    InputError
        If it takes other arguments, or has or returns another shape.
    """
    if callable(force):
        function = with_all_arguments(force, "force")
        return _returning(function, lambda tau: tau, (system.n_v,), "force")
    constant = checked_force(system, force) + np.zeros(system.n_v)
    return lambda t, q, last: constant


def with_all_arguments(function: Callable[..., Value], name: str) -> OfTimeQAndLast:
    """A user's function with the arguments (t, q, last), of which it may take fewer.

    The arguments without defaults decide which of these it is; the others keep their defaults.

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
    needed = needed_arguments(function, name)
    if needed == 3:
        return function
    if needed == 2:
        return lambda t, q, last: function(t, q)
    return lambda t, q, last: function(t)


def needed_arguments(function: Callable[..., Value], name: str) -> int:
    """How many of (t, q, last) a function takes, 1 to 3; InputError if it takes others."""
    try:
        parameters = list(signature(function).parameters.values())
    except (TypeError, ValueError):  # compiled, and without a signature
        return 1
    needed = [p for p in parameters if p.default is p.empty and p.kind not in ANY_NUMBER]
    names = [p.name for p in parameters if p.kind in NAMED]
    if names and names[0] != "q" and all(p.kind in NAMED for p in needed) and len(needed) <= 3:
        return max(1, len(needed))
    written = str(signature(function)).partition(" ->")[0]
    problem = "must be a function of t, of (t, q), or of (t, q, last)"
    raise InputError(problem, field=name, value=written)


def _returning(
    function: OfTimeQAndLast, unnamed: Callable[[Value], object], shape: tuple[int, ...], name: str
) -> Checked:
    """A user's function whose results are arrays of one shape."""

    def value(t: float, q: Array, last: StepResult | None) -> Array:
        returned = unnamed(function(t, q, last))
        try:
            array = np.asarray(returned, dtype=np.float64)
        except (TypeError, ValueError):
            array = np.asarray(np.nan)
        if array.shape != shape:
            remedy = f"; {FROM_LOADS}" if name == "force" else ""
            problem = f"must return numbers of shape {shape}{remedy}"
            raise InputError(problem, field=name, value=returned)
        return array

    return value
