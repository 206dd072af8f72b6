r"""How far the derivatives of an optimum hold, to first order: (R41).

A parameter that grows by t changes the slack of an open row to s + t ds, and the row touches at
t = -s / ds. The rows that touch, Z, exert A_Z' lam. But for their own motion, which carries that
along, it changes to v + t dv, and they go on touching while v + t dv is in the cone of A_Z'. Where
it leaves, at a facet whose normal u points inwards, the rows off that facet bear no more load:

.. math:: t = \min_u\; u\cdot v \quad\text{over}\quad A_Z u \ge 0,\; u\cdot dv = -1 .

No single lam is needed, and a lam of few rows would reach zero too early.
"""

from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import linprog, nnls

from quasistatic_ref.optional.derivatives.step.optimum_rates import DataRates, Equations
from quasistatic_ref.optional.derivatives.step.touching import unit_rows
from quasistatic_ref.step.data import Array, Indices, Mask
from quasistatic_ref.tolerances import DEPENDENT, NEARLY, SPLIT

AHEAD: Final = 1e-6
"""Change of a force, relative to it, up to which rows are tried to bear it on [-]: a million times
the rounding that would hide that it leaves their cone."""

FACET: Final = 1e-8
"""Product of a row of length one and the unit normal of a facet at which the row lies on it [-]:
a hundred times what HiGHS leaves."""

TIGHT = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
"""The least that HiGHS takes."""


class Distance(NamedTuple):
    """The distance to a kink.

    Parameters
    ----------
    t : float
        By how much the parameter changes until then [of the parameter]; infinite without a kink.
    rows : ndarray of int, shape (k, 2)
        Contact and row of those that touch there, or bear no more load.
    """

    t: float
    rows: Indices = np.zeros((0, 2), dtype=np.int64)


NEVER = Distance(np.inf)


class Reach:
    """The distances from an optimum to the next kinks, along P parameters.

    Parameters
    ----------
    equations : Equations
        What the optimum keeps.
    data : DataRates
        Those of the step.
    """

    def __init__(self, equations: Equations, data: DataRates) -> None:
        t = self.touching = equations.of
        self.rates = equations.rates(data)
        closing, known = equations.slack_rates(t.open, self.rates.x, data)
        self.closing = np.where(known, closing, 0.0)
        held = np.concatenate([t.strict, t.idle])
        rows = t.rows(held) @ t.inverse.T
        moving = rows.any(axis=1)
        self.held = held[moving]
        self.cone, _ = unit_rows(rows[moving])
        exerted = np.einsum("jiv,ji->v", t.generators, t.multipliers)
        self.force: Array = t.inverse @ exerted  # what the rows exert [(N m s)^0.5]
        self.size = float(np.linalg.norm(self.force))

    @cached_property
    def loads(self) -> Array:
        """Multipliers of the touching rows of length one, each far from zero if it can be, (k,)."""
        for share in self.size * 10.0 ** -np.arange(1, 12):
            least = np.full(len(self.cone), share / len(self.cone))
            more, miss = nnls(self.cone.T, self.force - self.cone.T @ least)
            if miss <= SPLIT * share:
                return np.asarray(least + more)
        return np.zeros(len(self.cone))

    @cached_property
    def loaded(self) -> Array:
        """How far at least each parameter may change until a row has no load, shape (P,)."""
        if not self.size:
            return np.full(self.rates.exerted.shape[1], np.inf)
        shares = np.linalg.lstsq(self.cone.T, self.rates.exerted, rcond=DEPENDENT)[0]
        left = np.full(shares.shape, np.inf)
        np.divide(self.loads[:, None], np.abs(shares), out=left, where=shares != 0)
        return np.asarray(left.min(axis=0, initial=np.inf))

    def along(self, one: DataRates) -> Distance:
        """The distance along a single parameter as it grows, beyond a kink that is here."""
        beyond = Equations(Equations(self.touching).beyond(one))
        return Reach(beyond, one).ahead(0)

    def ahead(self, column: int, sign: int = 1) -> Distance:
        """The distance to the next kink where a parameter grows, or falls: its sign is -1."""
        slack = self.touching.slack
        rate = sign * self.closing[:, column]
        left = np.full(len(slack), np.inf)
        np.divide(slack, -rate, out=left, where=rate < 0)
        t = float(left.min(initial=np.inf))
        nearest = Distance(t, self.touching.open[left <= (1 + NEARLY) * t]) if t < np.inf else NEVER
        if self.loaded[column] >= t:
            return nearest
        return min(nearest, self._unloaded(column, sign), key=lambda one: one.t)

    def either(self, column: int) -> Distance:
        """The distance to the next kink on the nearer side; 0 at a kink."""
        opens = self.rates.opens[:, column]
        if opens.any():
            return Distance(0.0, self.touching.idle[opens])
        return min(self.ahead(column, 1), self.ahead(column, -1), key=lambda one: one.t)

    def within(self, distance: Array) -> Indices:
        """The contact and row of every kink nearer than a distance, shape (k, 2).

        Parameters
        ----------
        distance : ndarray, shape (P,)
            One for each parameter [each in its parameter's unit].
        """
        slack = self.touching.slack[:, None]
        rates = np.abs(self.closing)
        kinks = [self.touching.open[(slack < distance * rates).any(axis=1)]]
        for column in np.flatnonzero(self.loaded < distance).tolist():
            for sign in (1, -1):
                if not self._goes_on(column, sign, distance[column]):
                    one = self._unloaded(column, sign)
                    kinks += [one.rows] if one.t < distance[column] else []
        near = np.concatenate(kinks)
        return np.unique(near, axis=0) if len(near) else near

    def _goes_on(self, column: int, sign: int, distance: float) -> bool:
        """Whether the rows surely bear what they exert beyond a distance: their cone is convex."""
        change = sign * self.rates.exerted[:, column]
        ahead = max(2 * distance, AHEAD * self.size / float(np.linalg.norm(change)))
        miss = nnls(self.cone.T, self.force + ahead * change)[1]
        return bool(miss <= SPLIT * self.size)

    def _unloaded(self, column: int, sign: int) -> Distance:
        """Where rows bear no more load."""
        change = sign * self.rates.exerted[:, column]
        size = self.size
        speed = float(np.linalg.norm(change))
        _, s, V = np.linalg.svd(self.cone, full_matrices=False)
        V = V[s > DEPENDENT * s[0]]
        rows = self.cone @ V.T
        v = V @ self.force / size
        dv = V @ change / speed
        nearest = max(self.loaded[column] * speed / size, FACET)  # so that the cost is about one
        u = _least(v / nearest, -rows, dv, -1.0, [(None, None)] * len(v))
        if u is None:
            return NEVER
        on = rows[rows @ u <= FACET * np.linalg.norm(u)]
        u = u - np.linalg.pinv(on, rcond=DEPENDENT) @ (on @ u)
        t = max(float(u @ v) / -float(u @ dv), 0.0)
        return Distance(t * size / speed, self.held[_unused(rows, v + t * dv)])


def _unused(rows: Array, force: Array) -> Mask:
    """Which rows (k, n) bear nothing of a `force` (n,) on the rim of their cone, shape (k,).

    They are off one of the facets that hold it; normals of all of these add up to that of a plane.
    """
    k, n = rows.shape
    u = _least(
        np.concatenate([np.zeros(n), -np.ones(k)]), np.hstack([-rows, np.eye(k)]),
        np.concatenate([force, np.zeros(k)]), 0.0, [(None, None)] * n + [(0.0, 1.0)] * k,
    )  # fmt: skip
    return np.zeros(k, dtype=bool) if u is None else np.asarray(u[n:] > 0.5)


def _least(
    cost: Array, below: Array, along: Array, length: float, bounds: list[tuple[float | None, ...]]
) -> Array | None:
    """The u of least cost with below u <= 0 and along . u = length; None if there is none."""
    for options in (TIGHT, {}):  # HiGHS may call a program unbounded that is not
        least = linprog(cost, below, np.zeros(len(below)), along[None], [length], bounds,
                        options=options)  # fmt: skip
        if least.status == 0:
            return np.asarray(least.x)
        if least.status == 2:  # nothing is feasible
            return None
    return None
