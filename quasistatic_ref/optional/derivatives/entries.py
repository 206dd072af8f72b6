"""A step by the entries of q, where its derivatives are in tangent coordinates."""

from collections.abc import Callable, Sequence
from typing import Final, Literal

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.model.configuration import normalised
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.derivatives import (
    EVERY_STEP,
    derivatives,
    directed,
    reasons_of,
)
from quasistatic_ref.optional.derivatives.nearby import Nearby, exact_step
from quasistatic_ref.optional.derivatives.parameters import with_parameters
from quasistatic_ref.optional.derivatives.reason import NotDifferentiable
from quasistatic_ref.simulate.simulator import Simulator

EPS: Final = 1e-5
"""Of central differences between entries of q and tangent coordinates [m, rad]: right to 1e-10."""

ROUNDING: Final = 1e-9
"""What they leave of a zero [-]."""

KEPT: Final = 16
"""Simulators of other parameters that are kept."""

Kinks = Literal["error", "nan"]
KINKS: Final = ("error", "nan")


class StepOfEntries:
    """A step, and its derivatives, by the entries of q, q_bar_a, the force and some parameters.

    Quaternions, and pairs (cos, sin), of any length stand for those of length one. All methods take
    these as arrays, of shapes (n_q,), (n_q_a,), (n_v,) and (P,) of each parameter.

    Parameters
    ----------
    simulator : Simulator
    by : tuple of str
        The names of the parameters.
    kinks : str
        ``"error"``: where there is no derivative is NotDifferentiable; ``"nan"``: NaN.
    """

    def __init__(self, simulator: Simulator, by: tuple[str, ...], kinks: Kinks) -> None:
        self._simulator = simulator
        self._system = simulator.system
        self._by = by
        self._kinks = kinks
        self._kept: dict[bytes, Simulator] = {}
        self.names = (*EVERY_STEP, *by)

    def end(self, *entries: Array) -> Array:
        """Where the step ends, shape (n_q,).

        Parameters
        ----------
        *entries : ndarray, shape (P,)
            The numbers of each of ``names`` [of the entry].
        """
        return exact_step(self._under(entries), *self._unit(entries), entries[2]).q

    def slope(self, *both: Array) -> Array:
        """The change of q+ along a tangent of each entry, which stand last, shape (n_q,).

        Parameters
        ----------
        *both : ndarray, shape (P,)
            The numbers of each of ``names``, then their tangents [of the entry].

        Raises
        ------
        NotDifferentiable
        """
        count = len(self.names)
        entries, tangents = both[:count], both[count:]
        if not all(np.isfinite(tangent).all() for tangent in tangents):
            return np.full(self._system.n_q, np.nan)  # a slope that is none, of a step before
        near = Nearby(self._under(entries), *self._unit(entries), entries[2])
        directions = {
            name: self._inward(name, entries) @ tangent
            for name, tangent in zip(self.names, tangents, strict=True)
            if tangent.any()
        }
        column, size = directed(near, directions)
        if column.problem and self._kinks == "error":
            raise NotDifferentiable(reasons_of({name: [column] for name in directions}))
        return np.asarray(self._outward(near.result.q) @ (size * column.rate))

    def columns(self, name: str, *entries: Array) -> Array:
        """The derivatives of q+ by one of the entries, shape (n_q, P).

        Parameters
        ----------
        name : str
            The entry's, of ``names``.
        *entries : ndarray, shape (P,)
            The numbers of each of ``names`` [of the entry].

        Raises
        ------
        NotDifferentiable
        """
        simulator = self._under(entries)
        rates = derivatives(simulator, *self._unit(entries), entries[2], name)
        if rates.reasons and self._kinks == "error":
            raise NotDifferentiable(rates.reasons)
        inward = self._inward(name, entries)
        rate = rates.by[name].rate
        none = np.isnan(rate).any(axis=0)
        whole = self._outward(rates.result.q) @ np.where(none, 0.0, rate) @ inward
        whole[:, (np.abs(inward[none]) > ROUNDING).any(axis=0)] = np.nan
        return np.asarray(whole)

    def _under(self, entries: Sequence[Array]) -> Simulator:
        """The simulator under the parameters, kept for those of the last calls."""
        if not self._by:
            return self._simulator
        values = dict(zip(self._by, entries[len(EVERY_STEP) :], strict=True))
        key = np.concatenate([*values.values()]).tobytes()
        kept = self._kept.pop(key, None) or with_parameters(self._simulator, values)
        self._kept[key] = kept
        if len(self._kept) > KEPT:
            del self._kept[next(iter(self._kept))]
        return kept

    def _unit(self, entries: Sequence[Array]) -> tuple[Array, Array]:
        """Both configurations, q and q_bar_a, with quaternions of length one."""
        system = self._system
        q, q_bar_a, *_ = entries
        at = system.checked(normalised(system.joints, q))
        whole = normalised(system.joints, system.with_actuated(at, q_bar_a))
        return at, system.checked(whole)[: system.n_q_a]

    def _inward(self, name: str, entries: Sequence[Array]) -> Array:
        """The derivative of tangent coordinates by entries of q or q_bar_a; of others, identity."""
        system = self._system
        if name not in ("q", "q_bar_a"):
            return np.eye(len(entries[self.names.index(name)]))
        q, q_bar_a, *_ = entries
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


def checked_kinks(kinks: object) -> Kinks:
    """What is done at kinks; InputError of any other word."""
    for word in KINKS:
        if kinks == word:
            return word
    raise InputError(f"must be {' or '.join(KINKS)}", field="kinks", value=kinks)


def _rates(function: Callable[[Array], Array], n: int, m: int) -> Array:
    """The derivative at 0 of m functions of n numbers, by central differences, shape (m, n)."""
    changes = [function(e) - function(-e) for e in EPS * np.eye(n)]
    return np.reshape(changes, (n, m)).T / (2 * EPS)
