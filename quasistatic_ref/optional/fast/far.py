r"""Contacts that do not touch: an optimum found without them is that of the step if they stay open.

Without the contacts that stay open, connected bodies fall into smaller groups: a heap into those
that press on each other. Which contacts these are is read from a backend's answer; that their rows
hold is proved here, from the minimisers of the groups in balls. Sums and products of the step's
numbers give h H and h g. With :math:`y = h\lambda` the minimiser on :math:`A_W x = b_W` is

.. math:: A_W (hH)^{-1} A_W^T y = b_W - A_W (hH)^{-1} hg, \qquad
          x = (hH)^{-1} (hg + A_W^T y).
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np
from flint import arb, arb_mat, ctx
from numpy.typing import NDArray

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.minimiser import PRECISION, inverse
from quasistatic_ref.certify.rational import h_times_hessian, matrix
from quasistatic_ref.certify.rounding import nearest_in
from quasistatic_ref.certify.rows import places
from quasistatic_ref.step.cones import cone_function, cone_matrix
from quasistatic_ref.step.data import Array, Indices, Mask, StepData
from quasistatic_ref.step.friction import row_constants


class BallHessian:
    """The inverse of h H in balls, of an H that is positive definite; kept while H stays.

    Parameters
    ----------
    step : StepData

    """

    def __init__(self, step: StepData) -> None:
        self.of = step.h, step.K_q, step.M_u
        H = h_times_hessian(step)
        with ctx.workprec(PRECISION):
            self.inverse = inverse(matrix(H.m)) * arb(2) ** -H.e
            self.h = arb(step.h)
            self.K_q = arb_mat(step.n_a, step.n_a, step.K_q.ravel().tolist())
            self.M_u = arb_mat(step.n_u, step.n_u, step.M_u.ravel().tolist())

    def fits(self, step: StepData) -> bool:
        """Whether a step has the same h, and the same arrays K_q and M_u."""
        h, K_q, M_u = self.of
        return h == step.h and K_q is step.K_q and M_u is step.M_u

    def h_times_g(self, step: StepData) -> arb_mat:
        """H g of Eq. :eq:`eq-13`, shape (n_v, 1)."""
        tau_k = self.K_q * _column(step.delta_q_bar_a)  # Eq. (1)
        tau = (tau_k + _column(step.tau_a)).entries() + step.tau_u.tolist()
        return arb_mat(step.n_v, 1, tau) * (self.h * self.h)  # Eq. (13)


class BallStep:
    """The minimisers of a step in balls.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    hessian : BallHessian
        That of the step.
    """

    def __init__(self, step: StepData, hessian: BallHessian) -> None:
        self.step = step
        self.hessian = hessian
        self._J: dict[int, arb_mat] = {}
        with ctx.workprec(PRECISION):
            self.free = hessian.inverse * hessian.h_times_g(step)

    def J(self, j: int) -> arb_mat:
        """Of contact j, shape (4, n_v)."""
        if j not in self._J:
            self._J[j] = arb_mat(self.step.contacts.J[j].tolist())
        return self._J[j]

    def rows(self, working: Sequence[int]) -> tuple[arb_mat, arb_mat]:
        """A_W and b_W: (n~ + d~_i)'J of Eq. (8) for each row of the working set."""
        step = self.step
        contacts = step.contacts
        contact, row = places(step, working)
        axes = np.stack([contacts.n, contacts.d1, contacts.d2], axis=2).tolist()
        mu = contacts.mu.tolist()
        table = cone_matrix(step.cone).tolist()
        constants = -row_constants(contacts, step.cone)
        entries = list[arb | float]()
        b = list[float]()
        for j, i in zip(contact.tolist(), row.tolist(), strict=True):
            if j == contacts.n_c:
                entries += step.extra.A[i].tolist()
                b.append(step.extra.b[i])
                continue
            gap, *others = map(arb, table[i])
            slip_1, slip_2, spin = (x * mu_x for x, mu_x in zip(others, mu[j], strict=True))
            along = [gap * n + slip_1 * d1 + slip_2 * d2 for n, d1, d2 in axes[j]]
            entries += (arb_mat(1, 4, [*along, spin]) * self.J(j)).entries()
            b.append(constants[j, i])
        return arb_mat(len(working), step.n_v, entries), _column(np.array(b))

    def minimiser(self, working: Sequence[int]) -> tuple[arb_mat, arb_mat, arb_mat] | None:
        """A_W, h lam and the minimiser x on A_W x = b_W; None if A_W is not seen to be regular."""
        A, b = self.rows(working)
        reached = A * self.hessian.inverse
        try:
            y = (reached * A.transpose()).solve(b - A * self.free)
        except ZeroDivisionError:
            return None
        return A, y, self.free + reached.transpose() * y


Balls: TypeAlias = list[arb]
Solved: TypeAlias = "tuple[Indices, StepData, BallHessian, Sequence[int]]"
"""Of a group: its coordinates, its step, the H of that, and the working set of its optimum."""


def balls(x: Array, rest: Array, bound: Array) -> Balls:
    """Numbers x + rest within a bound, shape (n,) each, in balls [any unit]."""
    columns = zip(x.tolist(), rest.tolist(), bound.tolist(), strict=True)
    with ctx.workprec(PRECISION):
        return [arb(middle) + arb(more, radius) for middle, more, radius in columns]


def displacement(step: StepData, solved: Sequence[Solved]) -> Balls | None:
    """Balls about the exact delta_q of all groups, n_v [m, rad]; None if one is not shown."""
    x = [arb(0)] * step.n_v
    with ctx.workprec(PRECISION):
        for coordinates, own, hessian, working in solved:
            found = BallStep(own, hessian).minimiser(working)
            if found is None:
                return None
            for v, x_v in zip(coordinates.tolist(), found[2].entries(), strict=True):
                x[v] = x_v
    return x


def far_slacks(step: StepData, far: Indices, x: Balls) -> tuple[Array, Mask]:
    """The slacks of the contacts that belong to no group, and which of these may not be open.

    Parameters
    ----------
    step : StepData
    far : ndarray of int, shape (k,)
        These contacts, ascending.
    x : list of arb, length n_v
        delta_q [m, rad].

    Returns
    -------
    ndarray, shape (rows of these contacts,)
        Rounded correctly [m], if each of them is shown to be positive.
    ndarray of bool, shape (n_c,)
        The contacts of which a slack is not.
    """
    place = np.full(step.contacts.n_c, -1)
    place[far] = np.arange(len(far))
    contact, coordinate, J = step.contacts.entries()
    counts = place[contact] >= 0
    columns = (place[contact][counts], coordinate[counts], J[counts])
    with ctx.workprec(PRECISION):
        motion = [arb(0)] * (4 * len(far))
        for j, v, column in zip(*(given.tolist() for given in columns), strict=True):
            for i, entry in enumerate(column, start=4 * j):
                motion[i] += x[v] * entry
        slacks, shown = all_nearest(contact_slacks(step, far, motion))
    doubtful = np.zeros(len(place), dtype=bool)
    doubtful[np.repeat(far, step.counts[far])[~shown | (slacks <= 0)]] = True
    return slacks, doubtful


def with_far(step: StepData, optimum: ExactOptimum, near: Mask, slacks: Array) -> ExactOptimum:
    """An optimum with the `slacks` of the contacts that are not `near`, which are all positive.

    Parameters
    ----------
    step : StepData
    optimum : ExactOptimum
        With zeros in their places.
    near : ndarray of bool, shape (n_c,)
    slacks : ndarray, shape (rows of these contacts,)
        [m].
    """
    slack = optimum.slack.copy()
    slack[: step.offsets[-1]][np.repeat(~near, step.counts)] = slacks
    least = [s for s in (optimum.smallest_inactive_slack, slacks.min()) if s is not None]
    return replace(optimum, slack=slack, smallest_inactive_slack=float(min(least)))


def all_nearest(balls: Sequence[arb]) -> tuple[Array, NDArray[np.bool_]]:
    """The float64 nearest to every number in each ball, and whether it is shown to be.

    Returns
    -------
    ndarray, shape (balls,)
        The float64 numbers [of the unit of the balls].
    ndarray of bool, shape (balls,)
    """
    midpoints = [float(ball) for ball in balls]
    off = np.array([float((b - x).abs_upper()) for b, x in zip(balls, midpoints, strict=True)])
    x = np.array(midpoints) + 0.0  # never -0.0
    with np.errstate(over="ignore", invalid="ignore"):
        gap = np.minimum(np.nextafter(x, np.inf) - x, x - np.nextafter(x, -np.inf))
    # gap / 2 is a float64 (0 of the least gap): an error that is not below it is not rounded to a
    # number below it.
    shown = (off < gap / 2) | (off == 0) & (x == 0)
    for i in np.flatnonzero(~shown & (off <= 2 * gap)).tolist():  # a power of two, or subnormal
        value = nearest_in(balls[i])
        x[i], shown[i] = (x[i], False) if value is None else (value, True)
    return x, shown


def contact_slacks(step: StepData, which: Sequence[int] | Indices, motion: list[arb]) -> list[arb]:
    """A x - b of the rows of some contacts: the cone's function of gap, slip and spin.

    Parameters
    ----------
    step : StepData
    which : sequence of int
        The contacts.
    motion : list of arb, length 4 len(which)
        J x of these [m, m, m, rad].
    """
    contacts = step.contacts
    rows = cone_function(step.cone)
    j = [*which]
    numbers = (contacts.phi, contacts.n, contacts.d1, contacts.d2, contacts.mu, step.counts)
    found = list[arb]()
    for i, (phi, n, d1, d2, (mu_v, _, mu_omega), count) in enumerate(
        zip(*(given[j].tolist() for given in numbers), strict=True)
    ):
        nu = motion[4 * i : 4 * i + 3]
        spin = motion[4 * i + 3]
        gap = _dot(n, nu) + phi
        slip_1 = _dot(d1, nu) * mu_v
        slip_2 = _dot(d2, nu) * mu_v
        found += rows(gap, slip_1, slip_2, spin * mu_omega)[:count]  # Eq. (4)
    return found


def _column(values: Array) -> arb_mat:
    return arb_mat(len(values), 1, values.tolist())


def _dot(direction: list[float], nu: list[arb]) -> arb:
    return nu[0] * direction[0] + nu[1] * direction[1] + nu[2] * direction[2]
