"""A step as a function that JAX differentiates, forwards and backwards.

The step itself runs outside of JAX, in float64 on the CPU. Forwards JAX is given one column, along
the direction that it asks for; backwards all columns of what is differentiated. Both are by the
entries of q: quaternions are normalised first, and their length has no gradient.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from types import ModuleType
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import check_arithmetic
from quasistatic_ref.optional.derivatives.derivatives import check_derivable
from quasistatic_ref.optional.derivatives.entries import StepOfEntries, checked_kinks
from quasistatic_ref.optional.derivatives.parameters import checked_names, values_of
from quasistatic_ref.parts import needed_package
from quasistatic_ref.simulate.simulator import Simulator


def step_jax(
    simulator: Simulator, by: str | Iterable[str] = (), kinks: str = "error"
) -> Callable[..., Any]:
    """The exact step as a function of JAX.

    Parameters
    ----------
    simulator : Simulator
        Of a polyhedral cone, without an extension.
    by : iterable of str
        Parameters that the function takes as keywords, of ``mu_v``, ``mu_omega``, ``K_q``, ``h``
        and ``masses``: as many numbers as :func:`.derivatives` has columns. K_q is its diagonal.
    kinks : str
        ``"error"``, or ``"nan"``: columns that do not exist are NaN.

    Returns
    -------
    callable
        (q, q_bar_a, force=0, and parameters by name) -> q after the step, the arguments as those of
        :meth:`~quasistatic_ref.simulate.simulator.Simulator.step`, in float64. A parameter that is
        left out is the simulator's.

    Raises
    ------
    InputError
        If JAX is not installed, or the step has no derivatives anywhere. The function raises it if
        its arguments are not those of ``Simulator.step`` in float64.
    NotDifferentiable
        By the function, where it is differentiated at a kink. Where JAX compiles (``jit``,
        ``scan``, ``vmap``), these and all errors about values arrive as JAX's own, a ValueError or
        JaxRuntimeError with the same sentence.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> callable(qr.step_jax(simulator))
    True
    """
    check_derivable(simulator)
    system = simulator.system
    own = {name: values_of(simulator)[name] for name in checked_names(by)}
    of_entries = StepOfEntries(simulator, (*own,), checked_kinks(kinks))
    jax = jax_package()
    sizes = {"q": (system.n_q,), "q_bar_a": (system.n_q_a,), "force": (system.n_v,)}
    sizes |= {name: value.shape for name, value in own.items()}
    calls = _Calls(of_entries, simulator, jax)

    def rule(primals: tuple[Any, ...], tangents: tuple[Any, ...]) -> tuple[Any, Any]:
        return step(*primals), _slope_primitive().bind(*primals, *tangents, calls=calls)

    step = jax.custom_jvp(calls.end)
    step.defjvp(rule)

    def checked(q: Any, q_bar_a: Any, force: Any = 0.0, **parameters: Any) -> Any:
        if not isinstance(force, jax.core.Tracer) and np.ndim(force) == 0 and force == 0:
            force = np.zeros(system.n_v)
        if unknown := parameters.keys() - own.keys():
            problem = "is not taken; name it in step_jax(simulator, by=...)"
            raise InputError(problem, field="a step in JAX", value=sorted(unknown)[0])
        one_number = {name for name in parameters if own[name].size == 1}
        parameters |= {name: jax.numpy.ravel(parameters[name]) for name in one_number}
        values = {"q": q, "q_bar_a": q_bar_a, "force": force} | own | parameters
        return step(*(_checked(jax, name, values[name], shape) for name, shape in sizes.items()))

    return checked


def jax_package() -> ModuleType:
    """The package JAX.

    Raises
    ------
    InputError
        If it is not installed.
    """
    return needed_package("jax", "jax", "a step in JAX")


class _Calls:
    """A step and its derivatives as functions that JAX calls on the host.

    Attributes
    ----------
    end : callable
        (q, q_bar_a, force, parameters one by one) -> q+.
    slope : callable
        (the same, a tangent of each) -> that of q+.
    columns : list of callable
        (the same) -> the derivatives of q+ by each of them.
    """

    def __init__(self, of: StepOfEntries, simulator: Simulator, jax: ModuleType) -> None:
        self._jax = jax
        self._lock = simulator.system.lock
        # JAX's own threads, which call back, flush subnormal numbers to zero; a thread has the
        # arithmetic of the one that starts it, which is therefore done here.
        self._thread = ThreadPoolExecutor(1)
        self._thread.submit(check_arithmetic).result()
        entries = ",".join(f"({name})" for name in of.names)
        self.end = self._outside(of.end, f"{entries}->(q)")
        self.slope = self._outside(of.slope, f"{entries},{entries}->(q)")
        self.columns = []
        for i, name in enumerate(of.names):
            columns = self._outside(partial(of.columns, name), f"{entries}->(q,{name})", i)
            once = jax.custom_jvp(columns)
            once.defjvp(_twice)
            self.columns.append(once)

    def _outside(self, function: Callable[..., Array], signature: str, *by: int) -> Any:
        """Makes a NumPy function callable from JAX; its result has the axes of q and `by` one."""
        jax = self._jax
        # Of vmap, one inside of another, there are more axes in front.
        each = np.vectorize(function, signature=signature)

        def alone(*arguments: Any) -> Any:
            numbers = [*map(np.asarray, arguments)]
            if any(one.dtype != np.float64 for one in numbers):  # they were when JAX took them
                problem = "was lost in a thread of JAX's own, where jax.enable_x64 does not hold: "
                problem += "jax.config.update('jax_enable_x64', True)"
                raise InputError(problem, field="float64")
            with self._lock:  # a system is for one thread, and each function has its own
                return each(*numbers)

        def in_thread(*arguments: Any) -> Any:
            return self._thread.submit(alone, *arguments).result()

        def called(*arguments: Any) -> Any:
            if not any(isinstance(one, jax.core.Tracer) for one in arguments):
                return jax.numpy.asarray(alone(*arguments))
            more = [arguments[i].shape[-1] for i in by]
            result = jax.ShapeDtypeStruct((*arguments[0].shape, *more), np.float64)
            return jax.pure_callback(in_thread, result, *arguments, vmap_method="broadcast_all")

        return called


def _twice(*arguments: Any, **parameters: Any) -> Any:
    """The rule of derivatives of derivatives: InputError."""
    problem = "has no second derivative: JAX has the first ones as numbers, take differences"
    raise InputError(problem, field="step in JAX")


@cache
def _slope_primitive() -> Any:
    """The change of q+ along tangents, in which it is linear, as an operation of JAX.

    Its arguments are q, q_bar_a, the force, the parameters, and a tangent of each.
    """
    from jax.extend.core import Primitive
    from jax.interpreters import ad, batching, mlir

    jax = jax_package()
    slope: Any = Primitive("slope_of_a_step")

    def called(*arguments: Any, calls: _Calls) -> Any:
        return calls.slope(*arguments)

    def shape(q: Any, *others: Any, calls: _Calls) -> Any:
        return jax.core.ShapedArray(q.shape, q.dtype)

    def batched(arguments: Any, axes: Any, calls: _Calls) -> tuple[Any, int]:
        each = [*zip(arguments, axes, strict=True)]
        count = next(one.shape[axis] for one, axis in each if axis is not None)
        every = [
            jax.numpy.broadcast_to(one, (count, *one.shape))
            if axis is None
            else jax.numpy.moveaxis(one, axis, 0)
            for one, axis in each
        ]
        return slope.bind(*every, calls=calls), 0

    def transposed(pull: Any, *arguments: Any, calls: _Calls) -> list[Any]:
        count = len(calls.columns)
        entries, tangents = arguments[:count], arguments[count:]
        pulled = [
            jax.numpy.einsum("...i,...ij->...j", pull, columns(*entries))
            if isinstance(tangent, ad.UndefinedPrimal)
            else None
            for columns, tangent in zip(calls.columns, tangents, strict=True)
        ]
        return [None] * len(entries) + pulled

    slope.def_impl(called)
    slope.def_abstract_eval(shape)
    mlir.register_lowering(slope, mlir.lower_fun(called, multiple_results=False))
    batching.primitive_batchers[slope] = batched
    ad.primitive_transposes[slope] = transposed
    ad.primitive_jvps[slope] = _twice
    return slope


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
