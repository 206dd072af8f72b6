"""A step as a function that JAX differentiates, forwards and backwards, with its verdict.

The step itself runs outside of JAX, in float64 on the CPU. JAX is given the derivatives by the
entries of q: with E as in
:func:`~quasistatic_ref.optional.derivatives.model.tangent.entry_rates`, those of q+ by q are
E(q+) dq_dq E(q)^+. Quaternions are normalised first: their length has no gradient.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.arithmetic import check_arithmetic
from quasistatic_ref.errors import InputError
from quasistatic_ref.model.configuration import normalised
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.derivatives import (
    check_derivable,
    check_nearly,
    derivatives,
)
from quasistatic_ref.optional.derivatives.gradient import Derivatives
from quasistatic_ref.optional.derivatives.model.tangent import entry_rates
from quasistatic_ref.optional.derivatives.smoothed import check_kappa, smoothed
from quasistatic_ref.optional.derivatives.step.reason import KINDS, NotDifferentiable, Reason
from quasistatic_ref.optional.derivatives.tolerances import NEARLY
from quasistatic_ref.parts import needed_package
from quasistatic_ref.simulate.simulator import Simulator

ARGUMENTS = ("q", "q_bar_a", "force", "kappa")
BY = ("dq_dq", "dq_dq_bar_a", "dq_dtau")
"""The derivatives by what a step is given: q, q_bar_a and the force."""

AT_KINKS = ("raise", "one-sided", "smoothed")

Differentiate = Callable[[Array, Array, Array, float], Derivatives]
"""q, q_bar_a, force, kappa -> the step with its derivatives."""


def step_jax(
    simulator: Simulator,
    kinks: str = "raise",
    *,
    towards: Mapping[str, ArrayLike] | None = None,
    kappa: float | None = None,
    nearly: float = NEARLY,
) -> Callable[..., Any]:
    """The exact step as a function of JAX.

    Parameters
    ----------
    simulator : Simulator
        Of a polyhedral cone, without an extension.
    kinks : str
        What JAX is given where the step has no derivative: ``"raise"``, nothing but an error;
        ``"one-sided"``, the derivatives on the side to which `towards` points; ``"smoothed"``,
        those of the smoothed step. An error where there are none of these either.
    towards : mapping, optional
        For ``"one-sided"``, with names, shapes (n_v,), (n_a,), ... and units [of the parameter] as
        in :func:`~quasistatic_ref.optional.derivatives.derivatives.derivatives`.
    kappa : float, optional
        For ``"smoothed"``, > 0, as in
        :func:`~quasistatic_ref.optional.derivatives.smoothed.smoothed` [N m s].
    nearly : float
        Distance to a kink [-] below which the state counts as at it, as in `derivatives`.

    Returns
    -------
    callable
        (q, q_bar_a, force=0) -> (q after the step, verdict), the arguments as those of
        :meth:`~quasistatic_ref.simulate.simulator.Simulator.step`, in float64. The verdict is an
        array of bool: which of the ``KINDS`` of
        :mod:`~quasistatic_ref.optional.derivatives.step.reason` stand in the way.

    Raises
    ------
    InputError
        If JAX is not installed, the option is unknown or lacks what it needs, or the step has no
        derivatives anywhere. The function raises it if its arguments are not those of
        ``Simulator.step`` in float64; under ``jit`` errors about values arrive as JaxRuntimeError.
    NotDifferentiable
        By the function, where a derivative that JAX needs does not exist.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> callable(qr.step_jax(simulator))
    True
    """
    if kinks not in AT_KINKS:
        raise InputError(f"must be one of {', '.join(AT_KINKS)}", field="kinks", value=kinks)
    for name, value, needs in (("towards", towards, "one-sided"), ("kappa", kappa, "smoothed")):
        if (value is not None) != (kinks == needs):
            raise InputError(f"goes with kinks={needs!r}, and with that only", field=name)
    check_nearly(nearly)
    if kappa is not None:
        check_kappa(kappa)

    def exact(q: Array, q_bar_a: Array, force: Array, _: float) -> Derivatives:
        return derivatives(simulator, q, q_bar_a, force, None, nearly)

    def instead(q: Array, q_bar_a: Array, force: Array, _: float) -> Derivatives:
        if kappa is not None:
            return smoothed(simulator, q, q_bar_a, kappa, force)
        return derivatives(simulator, q, q_bar_a, force, towards, nearly)

    step = _differentiable(simulator, exact, None if kinks == "raise" else instead)
    return lambda q, q_bar_a, force=0.0: step(q, q_bar_a, force, 0.0)


def smoothed_jax(simulator: Simulator) -> Callable[..., Any]:
    """The smoothed step as a function of JAX: where it ends, and the derivatives of that.

    Parameters
    ----------
    simulator : Simulator
        Of a polyhedral cone, without an extension.

    Returns
    -------
    callable
        (q, q_bar_a, kappa, force=0) -> (q after the step, verdict), otherwise as that of
        :func:`step_jax`. It has no derivative by kappa, the weight of the barriers [N m s].

    Raises
    ------
    InputError
        As :func:`step_jax` does.
    NotDifferentiable
        By the function, at kinks of the geometry.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> callable(qr.smoothed_jax(simulator))
    True
    """

    def derivatives_at(q: Array, q_bar_a: Array, force: Array, kappa: float) -> Derivatives:
        return smoothed(simulator, q, q_bar_a, kappa, force)

    step = _differentiable(simulator, derivatives_at, None)
    return lambda q, q_bar_a, kappa, force=0.0: step(q, q_bar_a, force, kappa)


def jax_package() -> ModuleType:
    """The package JAX.

    Raises
    ------
    InputError
        If it is not installed.
    """
    return needed_package("jax", "jax", "a step in JAX")


def _differentiable(
    simulator: Simulator, derivatives_at: Differentiate, instead: Differentiate | None
) -> Callable[..., Any]:
    """A function of (q, q_bar_a, force, kappa) for JAX; at kinks its derivatives are others."""
    check_derivable(simulator)
    jax = jax_package()
    system = simulator.system
    shaped = jax.ShapeDtypeStruct
    n_q = system.n_q
    sizes = ((n_q,), (system.n_q_a,), (system.n_v,), ())
    ends = (shaped((n_q,), np.float64), shaped((len(KINDS),), bool))
    matrices = tuple(shaped((n_q, n), np.float64) for n in (n_q, system.n_q_a, system.n_v))
    symbolic = jax.custom_derivatives.SymbolicZero

    # JAX's own threads, which call back, flush subnormal numbers to zero; a thread has the
    # arithmetic of the one that starts it, which is therefore done here.
    thread = ThreadPoolExecutor(1)
    thread.submit(check_arithmetic).result()

    def alone(names: tuple[str, ...], *arguments: Array) -> tuple[Array, ...]:
        rates_too = ",(q,by_q),(q,by_a),(q,by_v)" if names else ""
        # Of vmap, one inside of another, there are more axes in front.
        each = np.vectorize(
            partial(_rates, system, derivatives_at, instead, names),
            signature=f"(q),(a),(v),()->(q),(kinds){rates_too}",
        )
        with system.lock:  # a system is for one thread, and each function has its own
            return tuple(each(*arguments))

    @cache  # JAX compiles the call of each function once
    def outside(names: tuple[str, ...]) -> Callable[..., tuple[Array, ...]]:
        return lambda *arguments: thread.submit(alone, names, *map(np.asarray, arguments)).result()

    def called(names: tuple[str, ...], *arguments: Any) -> Any:
        if not any(isinstance(one, jax.core.Tracer) for one in arguments):
            return tuple(map(jax.numpy.asarray, alone(names, *map(np.asarray, arguments))))
        what = ends + (matrices if names else ())
        return jax.pure_callback(outside(names), what, *arguments, vmap_method="broadcast_all")

    def rule(primals: tuple[Any, ...], tangents: tuple[Any, ...]) -> Any:
        *moves, by_kappa = [not isinstance(tangent, symbolic) for tangent in tangents]
        if by_kappa:
            raise InputError("has no derivative of a step in JAX", field="kappa")
        names = tuple(name for name, moved in zip(BY, moves, strict=True) if moved)
        q_next, verdict, *by = once(names, *primals)
        change = sum(M @ t for M, t, on in zip(by, tangents, moves, strict=False) if on)
        none = jax.custom_derivatives.zero_from_primal(verdict, symbolic_zeros=True)
        return (q_next, verdict), (change, none)

    def twice(*arguments: Any) -> Any:
        problem = "has no second derivative: JAX has the first ones as numbers, take differences"
        raise InputError(problem, field="step in JAX")

    step = jax.custom_jvp(partial(called, ()))
    step.defjvp(rule, symbolic_zeros=True)
    once = jax.custom_jvp(called, nondiff_argnums=(0,))
    once.defjvp(twice)

    def checked(*arguments: Any) -> Any:
        force = arguments[2]
        if not isinstance(force, jax.core.Tracer) and np.ndim(force) == 0 and force == 0:
            arguments = (*arguments[:2], np.zeros(system.n_v), arguments[3])
        named = zip(ARGUMENTS, arguments, sizes, strict=True)
        return step(*(_checked(jax, *one) for one in named))

    return checked


def _checked(jax: ModuleType, name: str, value: Any, shape: tuple[int, ...]) -> Any:
    """An argument of a step in float64, of the shape that ``Simulator.step`` takes.

    Raises
    ------
    InputError
        If it is of another type or shape.
    """
    if not jax.config.jax_enable_x64:
        problem = "must be float64: jax.config.update('jax_enable_x64', True)"
        raise InputError(problem, field=name)
    try:
        array = jax.numpy.asarray(value)
    except (TypeError, ValueError) as error:
        raise InputError(f"must be numbers: {error}", field=name) from error
    if array.dtype.kind in "iu":
        array = array.astype(np.float64)
    if array.dtype != np.float64:
        problem = "must be float64; make it so by jax.numpy.asarray(x, dtype=float)"
        raise InputError(problem, field=name, value=str(array.dtype))
    if array.shape != shape:
        problem = f"must have shape {shape}; of several steps, use jax.vmap"
        raise InputError(problem, field=name, value=array.shape)
    return array


def _rates(
    system: System, derivatives_at: Differentiate, instead: Differentiate | None,
    names: tuple[str, ...],
    q: Array, q_bar_a: Array, force: Array, kappa: Array,
) -> tuple[Array, ...]:  # fmt: skip
    """Where the step ends, its verdict, and the derivatives by the entries of `names`."""
    at = system.checked(normalised(system.joints, q))
    whole = system.with_actuated(at, q_bar_a)
    goal = system.checked(normalised(system.joints, whole))[: system.n_q_a]
    of = derivatives_at(at, goal, force, float(kappa))
    kinds = {why.kind for why in _lacking(of, BY)}
    end = of.result.q
    verdict = np.array([kind in kinds for kind in KINDS])
    if not names:
        return end, verdict
    if instead is not None and _lacking(of, names):
        of = instead(at, goal, force, float(kappa))
    if lacking := _lacking(of, names):
        raise NotDifferentiable(lacking)
    onto = entry_rates(system.joints, end)
    back = np.linalg.pinv(entry_rates(system.joints, q))
    aim = np.linalg.pinv(entry_rates(system.joints, whole)[: system.n_q_a, : system.n_a])
    by = (back, aim, np.eye(system.n_v))
    products = [onto @ getattr(of, name) @ entries for name, entries in zip(BY, by, strict=True)]
    return end, verdict, *products


def _lacking(of: Derivatives, names: tuple[str, ...]) -> tuple[Reason, ...]:
    """Why the derivatives by some of `names` do not exist."""
    return tuple(why for why in of.reasons if {*why.fields} & {*names})
