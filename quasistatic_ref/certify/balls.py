"""The problem in ball arithmetic: numbers that carry a rigorous bound of their own error.

A sign that a ball shows is the true sign. What a ball around zero hides is left to
:mod:`~quasistatic_ref.certify.point`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from flint import arb, arb_mat, ctx, fmpz_mat

from quasistatic_ref.certify.rational import ExactForm
from quasistatic_ref.errors import StepDataError

PRECISION: Final = 320
"""Bits of a ball's midpoint. The data have 53 to 250; 256 is enough on grasps, and what is
left undecided is decided in rational numbers, so this is a matter of speed alone."""


@dataclass(frozen=True, eq=False)
class BallForm:
    """An exact form in balls.

    Parameters
    ----------
    H_inv : arb_mat
        H^-1.
    x_free : arb_mat
        H^-1 g, the unconstrained minimiser.
    A, b : arb_mat
    """

    H_inv: arb_mat
    x_free: arb_mat
    A: arb_mat
    b: arb_mat

    def rows(self, working: Sequence[int]) -> arb_mat:
        """Return the rows of A in a working set."""
        n = self.A.ncols()
        return arb_mat(len(working), n, [self.A[i, v] for i in working for v in range(n)])


@dataclass(frozen=True, eq=False)
class Balls:
    """The minimiser under A_i x = b_i for i in a working set, in balls.

    Parameters
    ----------
    x : list of arb, length n_v
    lam : list of arb
        Multipliers, in the order of the working set.
    net : list of arb, length n_v
        A_w' lam.
    slack : list of arb, length m
        A x - b.
    """

    x: list[arb]
    lam: list[arb]
    net: list[arb]
    slack: list[arb]


def ball_form(form: ExactForm) -> BallForm:
    """An exact form in balls, H proved to be positive definite.

    Raises
    ------
    StepDataError
        If H is not positive definite.
    """
    if not positive_definite(form.H):
        raise StepDataError("must be positive definite without rounding", field="H")
    H_inv = inverse(form.H)
    with ctx.workprec(PRECISION):
        return BallForm(H_inv, H_inv * arb_mat(form.g), arb_mat(form.A), arb_mat(form.b))


def inverse(H: fmpz_mat) -> arb_mat:
    """H^-1 in balls, of an H that is positive definite."""
    precision = PRECISION
    while True:  # ends: H is regular, so some precision resolves it
        with ctx.workprec(precision):
            try:
                return arb_mat(H).inv()
            except ZeroDivisionError:
                precision *= 2


def equality_solution(balls: BallForm, working: Sequence[int]) -> Balls | None:
    """The minimiser under A_i x = b_i for i in the working set, in balls.

    Parameters
    ----------
    balls : BallForm
    working : sequence of int
        Independent rows.

    Returns
    -------
    Balls or None
        None if the precision does not show that the rows are independent.
    """
    with ctx.workprec(PRECISION):
        A_w = balls.rows(working)
        b_w = arb_mat(len(working), 1, [balls.b[i, 0] for i in working])
        range_ = A_w * balls.H_inv
        try:
            lam = (range_ * A_w.transpose()).solve(b_w - A_w * balls.x_free)
        except ZeroDivisionError:
            return None
        x = balls.x_free + range_.transpose() * lam
        net, slack = A_w.transpose() * lam, balls.A * x - balls.b
        return Balls(x.entries(), lam.entries(), net.entries(), slack.entries())


def positive_definite(H: fmpz_mat) -> bool:
    """Whether a symmetric H is positive definite, decided exactly.

    By the pivots of H = L D L' in balls; by the leading minors where a pivot stays open.
    """
    n = H.nrows()
    with ctx.workprec(PRECISION):
        S = [[arb(H[i, j]) for j in range(i + 1)] for i in range(n)]
        for k in range(n):
            if not S[k][k] > 0:
                return not S[k][k] < 0 and _minors_positive(H)
            for i in range(k + 1, n):
                if S[i][k].is_zero():
                    continue
                factor = S[i][k] / S[k][k]
                for j in range(k + 1, i + 1):
                    S[i][j] = S[i][j] - factor * S[j][k]
    return True


def _minors_positive(H: fmpz_mat) -> bool:
    n = H.nrows()
    return all(
        fmpz_mat(k, k, [H[i, j] for i in range(k) for j in range(k)]).det() > 0
        for k in range(1, n + 1)
    )


def square_root(square: arb) -> arb:
    """The square root of what is not negative, whatever a ball about it holds."""
    return square.nonnegative_part().sqrt()
