r"""The derivative of the exact optimum along changes of a step's data, in float64: (R33).

Let S be the rows that bear load in some optimal lam. Of one contact they say that some combinations
of gap, slip_1, slip_2 and spin are zero: E of them, independent. With G what those are of delta_q,
and y the multipliers of gap, slips and spin, delta_q changes by

.. math:: H\,dx - (EG)^T d\eta = d\ell + dG^T y, \qquad EG\,dx = -E\,(dG\,x + d\phi) ,

where l is g - H x. If the rows of EG depend on each other, with :math:`\nu^T E G = 0`, that must
go on: :math:`\nu^T E\,(dG\,x + d\phi) = 0`, and :math:`dG^T E^T \nu` combines the rows. A row that
touches without load must keep its slack of zero. Where one of these fails there is no
derivative, but one on each side.

That the rank of [A_S b_S] stays |W| (R26) is seen at one other value of a parameter. For a gap this
is so because b is affine in the gap. For a coefficient mu > 0 it is so because the rows of a
contact, J_n plus mu times a slip, have the same b, and their differences span the same space at
every mu. Most parameters of a contact keep the rank, as they change all rows of this contact.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.optimize import nnls

from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.derivatives.step.touching import Touching, bearing, unit_rows
from quasistatic_ref.optional.derivatives.tolerances import CONSISTENT, DEPENDENT, SPLIT

INDEPENDENT: Final = 3e-4
"""Least singular value of rows of length one that are independent where a derivative is computed
[-]. Displacements are right to 1e-16 divided by it, and derivatives to 1e-16 divided by its square:
to 1e-9."""


@dataclass(frozen=True, eq=False)
class DataRates:
    """Derivatives of a step's data by P parameters.

    Parameters
    ----------
    load : ndarray, shape (n_v, P)
        Of g - H x, x being fixed [N s per unit].
    motion : ndarray, shape (n_c, 4, P)
        Of gap, slip_1, slip_2 and spin, x being fixed [m per unit].
    pull : callable
        y (n_c, 4) -> derivatives of G'y, shape (n_v, P): of what multipliers y [N s] of gap, slips
        and spin exert.
    terms : ndarray, shape (P,)
        How large the terms are whose sum is `motion` [m per unit]: its rounding is relative to it.
    """

    load: Array
    motion: Array
    terms: Array
    pull: Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class OptimumRates:
    """Derivatives of the optimum by P parameters.

    Parameters
    ----------
    x : ndarray, shape (n_v, P)
        Right for the parameters that nothing forbids [m, rad per unit].
    contradicts : dict of tuple of int to ndarray of bool
        By the contacts whose rows depend on each other and would not any more, for which of the
        parameters, shape (P,).
    opens : ndarray of bool, shape (idle rows, P)
        Which rows that touch without load would open on one side.
    closing : ndarray, shape (idle rows, P)
        How fast the slacks of these rows would change [m per unit].
    exerted : ndarray, shape (n_v, P)
        How the force of all rows changes but for the rows' own motion, solved by the Cholesky
        factor of H [(N m s)^0.5 per unit].
    """

    x: Array
    contradicts: dict[tuple[int, ...], Mask]
    opens: Mask
    closing: Array
    exerted: Array


class Equations:
    """The equations that the optimum keeps.

    Parameters
    ----------
    touching : Touching
    """

    def __init__(self, touching: Touching) -> None:
        self.of = touching
        self.E, self.kept = _combinations(touching)
        rows = self._combined(touching.generators) @ touching.inverse.T
        unit, self.length = unit_rows(rows)
        U, s, V = np.linalg.svd(unit)
        rank = int(np.count_nonzero(s > INDEPENDENT))
        self.U = U[:, :rank]
        self.s = s[:rank]
        self.V = V[:rank]
        self.free = V[rank:]
        self.null = U[:, rank:].T  # combinations that vanish, but for what is left of each
        self.left = np.zeros(len(self.null))
        self.left[: len(s) - rank] = s[rank:]

    def rates(self, data: DataRates) -> OptimumRates:
        """The derivatives, and what forbids them."""
        t = self.of
        right = -self._combined(data.motion) / self.length[:, None]
        forces = t.inverse @ (data.load + data.pull(t.multipliers))
        y = self.V.T @ ((self.U.T @ right) / self.s[:, None]) + self.free.T @ (self.free @ forces)
        x = t.inverse.T @ y
        closing, opens = self.slack_rates(t.idle, x, data)
        contradicts = self._contradictions(data, right, y)
        exerted = y - forces
        known = np.linalg.norm(exerted, axis=0) > CONSISTENT * np.linalg.norm(forces, axis=0)
        return OptimumRates(x, contradicts, opens, closing, exerted * known)

    def slack_rates(self, some: Indices, x: Array, data: DataRates) -> tuple[Array, Mask]:
        """How fast the slacks of some rows change [m per unit], and which of these are no rounding.

        Parameters
        ----------
        some : ndarray of int, shape (k, 2)
            Contact and row.
        x : ndarray, shape (n_v, P)
            Derivatives of the optimum.
        data : DataRates

        Returns
        -------
        rates, known : ndarray, shape (k, P)
        """
        rows = self.of.rows(some)
        moved = (self.of.table @ data.motion)[tuple(some.T)]
        rates = rows @ x + moved
        scale = np.abs(rows) @ np.abs(x) + np.abs(moved) + data.terms
        return rates, np.abs(rates) > CONSISTENT * scale

    def _combined(self, values: Array) -> Array:
        """The combinations of some `values` of gap, slips and spin, shape (n_c, 4, P)."""
        return np.asarray((self.E @ values)[self.kept])

    def _contradictions(
        self, data: DataRates, right: Array, y: Array
    ) -> dict[tuple[int, ...], Mask]:
        """Dependent rows that a parameter would set against each other."""
        contradictions: dict[tuple[int, ...], Mask] = {}
        terms = data.terms / self.length.min(initial=1.0)
        size = np.abs(right).max(axis=0, initial=0.0) + np.linalg.norm(y, axis=0) + terms
        owner = np.nonzero(self.kept)[0]
        for nu, left in zip(self.null, self.left, strict=True):
            bad = (np.abs(nu @ right) > CONSISTENT * size) | (left > SPLIT)
            if len(self.free):
                weights = np.zeros(self.kept.shape)
                weights[self.kept] = nu / self.length
                multipliers = np.einsum("jr,jri->ji", weights, self.E)
                pulled = self.of.inverse @ data.pull(multipliers)
                across = np.linalg.norm(self.free @ pulled, axis=0)
                bad |= across > CONSISTENT * np.maximum(np.linalg.norm(pulled, axis=0), 1.0)
            if bad.any():
                contacts = tuple(np.unique(owner[np.abs(nu) > DEPENDENT]).tolist())
                contradictions[contacts] = contradictions.get(contacts, False) | bad
        return contradictions

    def along(self, data: DataRates) -> Array:
        """The derivative along a single parameter as it grows, shape (n_v,) [m, rad per unit].

        The rows that touch without load keep their slack from falling below zero: the projection
        of the derivative without them on that cone, in the H norm.

        Parameters
        ----------
        data : DataRates
            Of one parameter that no equation contradicts.
        """
        t = self.of
        rates = self.rates(data)
        x = rates.x[:, 0]
        if not len(t.idle):
            return x
        rows, pushes = self._pushes(rates)
        return np.asarray(x + t.inverse.T @ (self.free.T @ (rows.T @ pushes)))

    def _pushes(self, rates: OptimumRates) -> tuple[Array, Array]:
        """Rows without load that the other equations leave, and what keeps each from closing."""
        t = self.of
        rows = t.rows(t.idle) @ t.inverse.T @ self.free.T
        return rows, _complementary(rows, rates.closing[:, 0])

    def beyond(self, data: DataRates) -> Touching:
        """What touches, and bears load, as soon as a single parameter has grown.

        Of the rows that touch without load, those that the growth presses then bear it, and those
        that it opens touch no more. Rows that it leaves as they are go on without load.

        Parameters
        ----------
        data : DataRates
            Of one parameter.
        """
        t = self.of
        rates = self.rates(data)
        if not len(t.idle):
            return t
        rows, pushes = self._pushes(rates)
        slack = rates.closing[:, 0] + rows @ (rows.T @ pushes)
        opened = slack > CONSISTENT * np.abs(rates.closing[:, 0]).max()
        unit, length = unit_rows(rows)
        size = float(np.linalg.norm(rows.T @ pushes))
        pressed = np.zeros(len(rows), dtype=bool)
        if size:
            pressed[~opened] = bearing(unit[~opened], (pushes * length)[~opened], size)
        strict = np.concatenate([t.strict, t.idle[pressed]])
        impulses = t.impulses.copy()
        impulses[tuple(t.idle[opened].T)] = 0.0  # a row that opens bears nothing
        return replace(t, strict=strict, idle=t.idle[~pressed & ~opened], impulses=impulses)


def _complementary(rows: Array, slack: Array) -> Array:
    """Pushes p >= 0, shape (k,), with slack + rows rows' p >= 0 and no product of both."""
    # The least motion z with rows z >= -slack is rows' p: the dual of a least-distance problem.
    k, n = rows.shape
    stacked = np.vstack([rows.T, -slack[None]])
    target = np.zeros(n + 1)
    target[n] = 1.0
    u, _ = nnls(stacked, target)
    residual = stacked @ u - target
    return np.asarray(u / -residual[n]) if -residual[n] > 0 else np.zeros(k)


def _combinations(touching: Touching) -> tuple[Array, Mask]:
    """Combinations of gap, slips and spin that the strict rows of each contact make zero.

    Returns
    -------
    ndarray, shape (n_c, k, 4)
    ndarray of bool, shape (n_c, k)
        Which of them these are; they are independent.
    """
    strict = np.zeros((len(touching.generators), len(touching.table)))
    strict[touching.strict[:, 0], touching.strict[:, 1]] = 1.0
    used = np.any(touching.generators, axis=2)
    rows = strict[:, :, None] * touching.table * used[:, None]
    _, s, V = np.linalg.svd(rows, full_matrices=False)
    return V, s > DEPENDENT * s[:, :1]
