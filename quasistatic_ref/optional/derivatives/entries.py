"""A step by the entries of q, where its derivatives are in tangent coordinates."""

from collections.abc import Callable
from typing import Final

import numpy as np

from quasistatic_ref.model.configuration import normalised
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.derivatives import (
    EVERY_STEP,
    derivatives,
    directed,
    reasons_of,
)
from quasistatic_ref.optional.derivatives.nearby import Nearby, exact_step
from quasistatic_ref.optional.derivatives.reason import NotDifferentiable
from quasistatic_ref.simulate.simulator import Simulator

EPS: Final = 1e-5
"""Of central differences between entries of q and tangent coordinates [m, rad]: right to 1e-10."""


class StepOfEntries:
    """A step, and its derivatives, by the entries of q, q_bar_a and the force.

    Quaternions, and pairs (cos, sin), of any length stand for those of length one.

    Parameters
    ----------
    simulator : Simulator
    """

    def __init__(self, simulator: Simulator) -> None:
        self._simulator = simulator
        self._system = simulator.system

    def end(self, q: Array, q_bar_a: Array, force: Array) -> Array:
        """Where the step ends, shape (n_q,)."""
        return exact_step(self._simulator, *self._unit(q, q_bar_a), force).q

    def slope(self, q: Array, q_bar_a: Array, force: Array, *tangents: Array) -> Array:
        """The change of q+ along tangents of q, q_bar_a and the force, shape (n_q,).

        Parameters
        ----------
        q : ndarray, shape (n_q,)
        q_bar_a : ndarray, shape (n_q_a,)
        force : ndarray, shape (n_v,)
            [N, N m].
        tangents : ndarray, shapes of q, q_bar_a and the force
            What each changes by, in its units [of each].

        Raises
        ------
        NotDifferentiable
        """
        near = Nearby(self._simulator, *self._unit(q, q_bar_a), force)
        directions = {
            name: self._inward(name, q, q_bar_a) @ tangent
            for name, tangent in zip(EVERY_STEP, tangents, strict=True)
            if tangent.any()
        }
        column, size = directed(near, directions)
        if column.problem:
            raise NotDifferentiable(reasons_of({name: [column] for name in directions}))
        return np.asarray(self._outward(near.result.q) @ (size * column.rate))

    def columns(self, name: str, q: Array, q_bar_a: Array, force: Array) -> Array:
        """The derivatives of q+ by q, q_bar_a or the force, shape (n_q, P).

        Raises
        ------
        NotDifferentiable
        """
        rates = derivatives(self._simulator, *self._unit(q, q_bar_a), force, name)
        if rates.reasons:
            raise NotDifferentiable(rates.reasons)
        inward = self._inward(name, q, q_bar_a)
        return np.asarray(self._outward(rates.result.q) @ rates.by[name].rate @ inward)

    def _unit(self, q: Array, q_bar_a: Array) -> tuple[Array, Array]:
        """Both configurations, q and q_bar_a, with quaternions of length one."""
        system = self._system
        at = system.checked(normalised(system.joints, q))
        whole = normalised(system.joints, system.with_actuated(at, q_bar_a))
        return at, system.checked(whole)[: system.n_q_a]

    def _inward(self, name: str, q: Array, q_bar_a: Array) -> Array:
        """The derivative of tangent coordinates by entries of q or of q_bar_a."""
        system = self._system
        if name == "tau":
            return np.eye(system.n_v)
        here = q if name == "q" else system.with_actuated(system.q_start, q_bar_a)
        unit = normalised(system.joints, here)

        def change(e: Array) -> Array:
            return system.difference(unit, normalised(system.joints, here + e))

        whole = _rates(change, system.n_q, system.n_v)
        return whole if name == "q" else whole[: system.n_a, : system.n_q_a]

    def _outward(self, q: Array) -> Array:
        """How the entries of q change with its tangent coordinates, shape (n_q, n_v)."""
        system = self._system
        return _rates(lambda e: system.integrate(q, e), system.n_v, system.n_q)


def _rates(function: Callable[[Array], Array], n: int, m: int) -> Array:
    """The derivative at 0 of m functions of n numbers, by central differences, shape (m, n)."""
    changes = [function(e) - function(-e) for e in EPS * np.eye(n)]
    return np.reshape(changes, (n, m)).T / (2 * EPS)
