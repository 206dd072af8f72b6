r"""Contact forces by compliance in the ellipsoid, enclosed in balls.

With the compliance eliminated (:mod:`~quasistatic_ref.certify.compliance.forces`) the energy is
1/2 x'Hx - g'x + h/(2c) sum_j ||s_j||^2, where s_j is the point of the cone F = {s : s_0 >= ||s_t||}
nearest to -z_j. Let G be its gradient. It is strongly convex: for any x that satisfies the user's
own rows E x >= e, and any y >= 0,

.. math:: \tfrac12\|x - x^*\|_H^2 \le y^T (E x - e) + \tfrac12\|G(x) - E^T y\|_{H^{-1}}^2.

The nearest point moves no farther than z, so that s_j is right to the length of
B_j (x - x^*). Newton's method makes the right side as small as the precision is.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from flint import arb, arb_mat, ctx

from quasistatic_ref.certify.compliance.eliminated import EliminatedStep
from quasistatic_ref.certify.compliance.face_guess import lengths_of
from quasistatic_ref.certify.compliance.forces import WRENCH, ContactForces
from quasistatic_ref.certify.minimiser import inner, square_root
from quasistatic_ref.certify.rational import Dyadic, two_to
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.optional.ellipsoid.enclosure import rounded
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import scaled_by

BITS: Final = 640
ROUNDS: Final = 20
"""Changes of the set of the user's rows that hold as equations, at most."""
ITERATIONS: Final = 1000
"""Newton iterations, at most; eight to twenty do on grasps."""
ROUGH, NEAR = arb(2) ** -200, arb(2) ** -500
"""Squares of the length of a Newton step, relative to that of x in the norm of H: down to the first
the energy decides how much of it is taken; below the second it is the last one."""
INSIDE: Final = arb(2) ** -400
"""How far inside of the user's rows that hold x is sought, relative to the largest gap: x then
surely satisfies them."""
DESCENT: Final = arb(1e-4)
"""Share of the descent that the slope promises with which a step is content (Armijo)."""
TIGHT: Final = arb(2) ** -40
"""Slack of a user's row, relative to the terms of its sum, below which the row is held at first."""
WIDE: Final = arb(2) ** -200
"""Largest square of an enclosure's size that is accepted, relative to those of x and H^-1 g."""
LEAST: Final = arb(2) ** -60
"""Shortest part of a Newton step."""


@dataclass(frozen=True, eq=False)
class Pushed:
    """The point of F nearest to -z, and its derivative by z.

    Parameters
    ----------
    s : arb_mat, shape (4, 1)
    by_z : arb_mat, shape (4, 4)
    """

    s: arb_mat
    by_z: arb_mat


def pushed(z: arb_mat) -> Pushed:
    """The point of F nearest to -z, shape (4, 1) [m]; where balls leave the case open, any."""
    first, *rest = (-z).entries()
    length = square_root(sum((v * v for v in rest), arb(0)))
    if first >= length:
        return Pushed(-z, arb_mat([[-(i == k) for k in range(4)] for i in range(4)]))
    if -first >= length or not length > 0:
        return Pushed(arb_mat(4, 1), arb_mat(4, 4))
    along = arb_mat(4, 1, [arb(1), *(v / length for v in rest)])
    turn = first / length
    by_z = along * along.transpose()
    for i in range(1, 4):
        for k in range(1, 4):
            by_z[i, k] = (1 + turn) * (i == k) - turn * along[i, 0] * along[k, 0]
    return Pushed(along * ((first + length) / 2), by_z * arb(-0.5))


class CompliantStep:
    """The step with compliance in delta_q alone, in balls; its energy is times h c.

    Parameters
    ----------
    step : StepData
    compliance : float
        [m/N].
    """

    def __init__(self, step: StepData, compliance: float) -> None:
        exact = EliminatedStep(step, compliance)
        n = step.n_v
        self.H = in_balls(exact.H)
        self.g = in_balls(exact.g)
        self.k = arb(step.h) ** 2
        self.B = [in_balls(exact.z[j, :, :n]) for j in range(step.contacts.n_c)]
        self.gap = [in_balls(exact.z[j, :, n]) for j in range(step.contacts.n_c)]
        self.E = in_balls(exact.own[:, :n])
        self.e = in_balls(-exact.own[:, n])

    def pushed(self, x: arb_mat, more: Sequence[arb_mat] | None = None) -> list[Pushed]:
        """What each contact gives way at x, where z is as it is there, and perhaps `more`."""
        z = [B * x + gap for B, gap in zip(self.B, self.gap, strict=True)]
        if more is not None:
            z = [z_j + more_j for z_j, more_j in zip(z, more, strict=True)]
        return [pushed(z_j) for z_j in z]

    def energy(self, x: arb_mat, give: Sequence[Pushed]) -> arb:
        """The energy at x."""
        squares = sum((v * v for one in give for v in one.s.entries()), arb(0))
        return inner(x, self.H * x / 2 - self.g) + self.k * squares / 2

    def gradient(self, x: arb_mat, give: Sequence[Pushed]) -> arb_mat:
        """Its gradient at x."""
        total = self.H * x - self.g
        for B, one in zip(self.B, give, strict=True):
            total -= B.transpose() * one.s * self.k
        return total

    def newton(self, x: arb_mat, give: Sequence[Pushed], held: Sequence[int]) -> arb_mat:
        """The step from x to the minimiser of the energy's quadratic model, and multipliers.

        Rows that are `held` are equations. Shape (n_v + held, 1); without radius.
        """
        n = x.nrows()
        k = len(held)
        H = self.H
        for B, one in zip(self.B, give, strict=True):
            H = H - B.transpose() * one.by_z * B * self.k
        K = arb_mat(n + k, n + k)
        right = arb_mat(n + k, 1)
        off = self.gradient(x, give)
        short = self.e - self.E * x
        inside = INSIDE * max((abs(gap[0, 0]) for gap in self.gap), default=arb(1))
        for i in range(n):
            right[i, 0] = -off[i, 0]
            for j in range(n):
                K[i, j] = H[i, j]
        for row, i in enumerate(held, start=n):
            right[row, 0] = short[i, 0] + inside
            for j in range(n):
                K[row, j] = self.E[i, j]
                K[j, row] = -self.E[i, j]
        return K.solve(right, algorithm="approx").mid()

    def minimiser(
        self, x: arb_mat, give: list[Pushed], held: Sequence[int]
    ) -> tuple[arb_mat, list[arb]]:
        """The minimiser of the energy where the rows `held` are equations; and multipliers."""
        n = x.nrows()
        first = True  # the first step starts from a guess, and off the rows
        for _ in range(ITERATIONS):
            found = self.newton(x, give, held).entries()
            way = arb_mat(n, 1, found[:n])
            y = found[n:]
            length = self.squared(way)
            whole = self.squared(x) + self.squared(way)
            if not first and length > ROUGH * whole:
                way = way * self.share(x, give, way)
            x = (x + way).mid()
            first = False
            if not length > NEAR * whole:
                break
            give = self.pushed(x)
        return x, y

    def share(self, x: arb_mat, give: Sequence[Pushed], way: arb_mat) -> arb:
        """The part of a Newton step that lowers the energy by enough."""
        energy = self.energy(x, give)
        slope = inner(self.gradient(x, give), way)
        share = arb(1)
        while share > LEAST:
            there = (x + way * share).mid()
            if self.energy(there, self.pushed(there)) < energy + DESCENT * share * slope:
                break
            share /= 2
        return share

    def squared(self, x: arb_mat) -> arb:
        """||x||_H^2."""
        return inner(x, self.H * x).mid()

    def on_active_rows(self, x: arb_mat, give: list[Pushed]) -> tuple[arb_mat, arb_mat]:
        """The minimiser under the user's own rows, and the multipliers of all of them."""
        held = [i for i in range(self.E.nrows()) if self.tight(i, x)]
        for _ in range(ROUNDS):
            x, y = self.minimiser(x, give, held)
            give = self.pushed(x)
            pressed = [i for i, y_i in zip(held, y, strict=True) if y_i > 0]
            broken = [i for i, v in enumerate((self.E * x - self.e).entries()) if v < 0]
            if pressed == held and not broken:
                break
            held = sorted({*pressed, *broken})
        every = arb_mat(self.E.nrows(), 1)
        for i, y_i in zip(held, y, strict=True):
            every[i, 0] = y_i
        return x, every

    def tight(self, i: int, x: arb_mat) -> bool:
        """Whether x seems to break a user's row, or to be on it."""
        terms = [self.E[i, v] * x[v, 0] for v in range(x.nrows())]
        size = sum((abs(term) for term in terms), arb(0))
        return bool(sum(terms, arb(0)) - self.e[i, 0] < TIGHT * size)

    def distance(self, x: arb_mat, y: arb_mat, H_inv: arb_mat) -> arb:
        """A bound of ||x - x*||_H; infinite where x or y is not proved to be admissible."""
        slack = self.E * x - self.e
        if not all(v >= 0 for v in (*slack.entries(), *y.entries())):
            return arb("inf")
        off = self.gradient(x, self.pushed(x)) - self.E.transpose() * y
        return square_root(2 * inner(y, slack) + inner(off, H_inv * off))


def compliant_forces(step: StepData, compliance: float, near: tuple[Array, Array]) -> ContactForces:
    """The contact forces of a step in the ellipsoid.

    Parameters
    ----------
    step : StepData
    compliance : float
        Of each contact [m/N].
    near : (ndarray, ndarray)
        delta_q, shape (n_v,) [m, rad], and wrenches, shape (n_c, 4) [N, N m], of the step without
        compliance.

    Returns
    -------
    ContactForces
        Rounded from enclosures of 1e-30 of the loads or less; 0.0 where an enclosure holds zero.

    Raises
    ------
    StepNotSolved
        If no enclosure is found.
    """
    n = step.n_v
    delta_q, wrench = near
    mu = scaled_by(step.contacts).tolist()
    give = lengths_of(wrench, step, compliance)
    numbers: list[list[float]] = []
    with ctx.workprec(BITS):
        program = CompliantStep(step, compliance)
        H_inv = program.H.inv()
        start = arb_mat(n, 1, delta_q.tolist())
        guess = [arb_mat(4, 1, (-s).tolist()) for s in give]
        place, y = program.on_active_rows(start, program.pushed(start, guess))
        error = program.distance(place, y, H_inv)
        if not error * error <= WIDE * (
            program.squared(place) + program.squared(H_inv * program.g)
        ):
            raise StepNotSolved("none", "no enclosure of the contact forces was found", step, 0.0)
        for B, mu_j, one in zip(program.B, mu, program.pushed(place), strict=True):
            reach = B * H_inv * B.transpose()
            moved = square_root(sum((reach[i, i] for i in range(4)), arb(0))) * error
            s = [v + arb(0, moved.upper()) for v in one.s.entries()]
            numbers.append([rounded(m * v / compliance) for m, v in zip(mu_j, s, strict=True)])
        off = [square_root(H_inv[i, i]) * error for i in range(n)]
        x = [rounded(place[i, 0] + arb(0, off[i].upper())) for i in range(n)]
    return ContactForces(np.array(numbers).reshape(-1, 4)[:, WRENCH], np.array(x))


def in_balls(numbers: Dyadic) -> arb_mat:
    """The same numbers, of any unit, in balls without radius: a matrix, or a column."""
    table = np.atleast_2d(numbers.m.T).T
    unit = arb(two_to(numbers.e))
    rows, columns = table.shape
    return arb_mat(rows, columns, [arb(int(m)) * unit for m in table.ravel()])
