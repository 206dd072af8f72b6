r"""The optimum on a working set that was guessed right, confirmed in balls without forming A.

Where a backend answers well, the rows whose multipliers exceed their slacks are mostly a working
set of the optimum. Sums and products of the step's numbers give h H and h g. With
:math:`y = h\lambda` the minimiser on :math:`A_W x = b_W` is

.. math:: A_W (hH)^{-1} A_W^T y = b_W - A_W (hH)^{-1} hg, \qquad
          x = (hH)^{-1} (hg + A_W^T y).

It is the optimum if the first matrix is regular (the rows of W are then independent), y > 0, and
no other row has a negative slack. Balls show all of that but the slacks that are zero. These, and
coordinates that are zero, follow from how the rows of a contact are combined, from the rank of
exact rows, or from the rational solution on W
(:mod:`~quasistatic_ref.optional.fast.guess.zeros`). What stays open is left to
:mod:`~quasistatic_ref.certify.exact`, which decides everything.
"""

from collections.abc import Sequence

import numpy as np
from flint import arb, arb_mat, ctx
from numpy.typing import NDArray

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.minimiser import PRECISION, inverse
from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.certify.rational import h_times_hessian, matrix
from quasistatic_ref.certify.rounding import nearest_in
from quasistatic_ref.certify.rows import places
from quasistatic_ref.optional.fast.guess.exchange import Proof, Refuted
from quasistatic_ref.optional.fast.guess.zeros import zeros
from quasistatic_ref.step.cones import cone_function, cone_matrix
from quasistatic_ref.step.data import Array, Indices, StepData
from quasistatic_ref.step.friction import row_constants


class BallHessian:
    """The inverse of h H in balls, of an H that is positive definite; kept while H stays.

    Parameters
    ----------
    step : StepData

    Attributes
    ----------
    norm : EnergyNorm
        Of H in float64.

    Raises
    ------
    StepDataError
        If H, whose entries are rounded, is not positive definite.
    """

    def __init__(self, step: StepData) -> None:
        self.of = step.h, step.K_q, step.M_u
        H = h_times_hessian(step)
        with ctx.workprec(PRECISION):
            self.inverse = inverse(matrix(H.m)) * arb(2) ** -H.e
            self.h = arb(step.h)
            self.K_q = arb_mat(step.n_a, step.n_a, step.K_q.ravel().tolist())
            self.M_u = arb_mat(step.n_u, step.n_u, step.M_u.ravel().tolist())
        self.norm = energy_norm(step.H)

    def fits(self, step: StepData) -> bool:
        """Whether a step has the same h, and the same arrays K_q and M_u."""
        h, K_q, M_u = self.of
        return h == step.h and K_q is step.K_q and M_u is step.M_u

    def h_times_g(self, step: StepData) -> arb_mat:
        """H g of Eq. :eq:`eq-13`, shape (n_v, 1)."""
        tau_k = self.K_q * _column(step.delta_q_bar_a)  # Eq. (1)
        tau = (tau_k + _column(step.tau_a)).entries() + step.tau_u.tolist()
        return arb_mat(step.n_v, 1, tau) * (self.h * self.h)  # Eq. (13)

    def net(self, step: StepData, delta_q: list[arb]) -> list[arb]:
        """H delta_q - g = A'lam of Eq. :eq:`eq-9`: exact where H couples zeros only."""
        n_a = step.n_a
        n_u = step.n_u
        off = arb_mat(n_a, 1, delta_q[:n_a]) - _column(step.delta_q_bar_a)
        actuated = (self.K_q * off - _column(step.tau_a)) * self.h
        moved = self.M_u * arb_mat(n_u, 1, delta_q[n_a:])
        parts = zip(moved.entries(), step.tau_u.tolist(), strict=True)
        return actuated.entries() + [p / self.h - self.h * tau for p, tau in parts]


class BallStep:
    """A step in balls: what the proofs of all guesses of its working set have in common.

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

    def confirmed(self, guess: Sequence[int] | Indices) -> Proof:
        """The exact optimum, if a guess of its working set is right and balls show it.

        Parameters
        ----------
        guess : sequence of int
            Rows, as from :func:`~quasistatic_ref.certify.warm.warm_rows`.

        Returns
        -------
        ExactOptimum, Refuted or None
            None where something stays open.
        """
        step = self.step
        hessian = self.hessian
        working = sorted({int(i) for i in guess})
        with ctx.workprec(PRECISION):
            found = self.minimiser(working)
            if found is None:
                return None
            A, y, x = found
            lam = y * (1 / hessian.h)
            every = range(step.contacts.n_c)
            motion = [moved for j in every for moved in (self.J(j) * x).entries()]
            slacks = contact_slacks(step, every, motion)
            if step.extra.names:
                A_own = arb_mat(len(step.extra.names), step.n_v, step.extra.A.ravel().tolist())
                slacks += (A_own * x - _column(step.extra.b)).entries()
            if any(slack < 0 for slack in slacks) or not all(v > 0 for v in lam.entries()):
                point = _nonzero(lam.entries()), _nonzero(slacks)
                return Refuted(np.array(working, dtype=np.int64), *point)
            net = A.transpose() * lam
            numbers, shown = all_nearest((*lam.entries(), *net.entries(), *x.entries(), *slacks))
        ends = np.cumsum([len(working), step.n_v, step.n_v])
        lam_w, impulse, delta_q, slack = np.split(numbers, ends)
        open_lam, open_impulse, open_x, open_slack = np.split(~shown, ends)
        slack[open_slack] = slack[working] = 0.0  # the open ones: to be proved
        idle = sorted(set(np.flatnonzero(slack == 0).tolist()) - set(working))
        still = np.flatnonzero(open_x).tolist()
        delta_q[still] = 0.0
        if open_lam.any():
            return None
        means = zeros(step, working, idle, still)
        if means is None:
            return None
        if open_impulse.any():
            at = [arb(0) if v in still else x[v, 0] for v in range(step.n_v)]
            with ctx.workprec(PRECISION):
                impulse, shown = all_nearest(hessian.net(step, at))
            if not shown.all():
                return None
        positive = slack[slack > 0].tolist()
        lam_of_rows = np.zeros(len(slack))
        lam_of_rows[working] = lam_w
        return ExactOptimum(
            delta_q=delta_q,
            lam=lam_of_rows,
            net=impulse,
            slack=slack,
            working_set=tuple(working),
            multipliers_unique=means.unique,
            differentiable=means.smooth,
            smallest_inactive_slack=min(positive, default=None) if means.smooth else 0.0,
            smallest_active_multiplier=min(lam_w.tolist(), default=None),
            walks=0,
        )


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


def _nonzero(balls: Sequence[arb]) -> Array:
    """The numbers in some balls, shape (balls,) [of their unit]; 0 where a ball holds zero."""
    return np.array([0.0 if ball.contains(0) else float(ball) for ball in balls])


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
