"""The minimiser on a working set, with every sign that is needed decided exactly.

A sign is read from balls (numbers that carry a rigorous bound of their own error) where they show
it, from an exact linear dependence where a row is one, and from the rational solution of the KKT
system otherwise. That solution takes the longest to compute, and is kept for the next sign.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, cast

from flint import arb, arb_mat, ctx, fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.certify.dependence import follow
from quasistatic_ref.certify.rational import ExactForm

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
class BallSolution:
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


def form_in_balls(form: ExactForm) -> BallForm:
    """An exact form in balls; its H is positive definite, as that of a step is."""
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


def equality_solution(form: BallForm, working: Sequence[int]) -> BallSolution | None:
    """The minimiser under A_i x = b_i for i in the working set, in balls.

    Parameters
    ----------
    form : BallForm
    working : sequence of int
        Independent rows.

    Returns
    -------
    BallSolution or None
        None if the precision does not show that the rows are independent.
    """
    with ctx.workprec(PRECISION):
        A_w = form.rows(working)
        b_w = arb_mat(len(working), 1, [form.b[i, 0] for i in working])
        A_H_inv = A_w * form.H_inv
        try:
            lam = (A_H_inv * A_w.transpose()).solve(b_w - A_w * form.x_free)
        except ZeroDivisionError:
            return None
        x = form.x_free + A_H_inv.transpose() * lam
        net = A_w.transpose() * lam
        slack = form.A * x - form.b
        return BallSolution(x.entries(), lam.entries(), net.entries(), slack.entries())


def square_root(square: arb) -> arb:
    """The square root of what is not negative, whatever a ball about it holds."""
    return square.nonnegative_part().sqrt()


def inner(u: arb_mat, v: arb_mat) -> arb:
    """Inner product u'v of two columns (n, 1) [product of their units]."""
    return (u.transpose() * v)[0, 0]


@dataclass(frozen=True, eq=False)
class RationalSolution:
    """A solution of H x = g + A_w' lam, A_w x = b_w: fractions of one positive denominator.

    Parameters
    ----------
    x, lam, net, slack : list of fmpz
        Numerators; ``net`` is A_w' lam, ``slack`` is A x - b for all m rows.
    denominator : fmpz
    """

    x: list[fmpz]
    lam: list[fmpz]
    net: list[fmpz]
    slack: list[fmpz]
    denominator: fmpz

    @property
    def point(self) -> list[fmpq]:
        """The minimiser x in fractions, in the form's units [-]."""
        return [fmpq(v) / self.denominator for v in self.x]


def rational_solution(form: ExactForm, working: tuple[int, ...]) -> RationalSolution:
    """The minimiser under A_i x = b_i for i in a working set, without rounding.

    Raises
    ------
    ZeroDivisionError
        If the rows are not independent.
    """
    n = form.n
    k = len(working)
    A_w = form.rows(working)
    above = [[*H_i, *(-a[i] for a in A_w)] for i, H_i in enumerate(form.H.tolist())]
    below = [[*a, *[fmpz(0)] * k] for a in A_w]
    K = fmpz_mat(n + k, n + k, [entry for row in above + below for entry in row])
    right = fmpz_mat(n + k, 1, form.g.entries() + [form.b[i, 0] for i in working])
    numerators, denominator = cast("fmpq_mat", K.solve(right)).numer_denom()  # positive
    entries = numerators.entries()
    x = fmpz_mat(n, 1, entries[:n])
    lam = entries[n:]
    net = form.H * x - form.g * denominator
    slack = form.A * x - form.b * denominator
    return RationalSolution(x.entries(), lam, net.entries(), slack.entries(), denominator)


class Minimiser:
    """The minimiser x of 1/2 x'Hx - g'x under A_i x = b_i for i in the working set.

    Parameters
    ----------
    form : ExactForm
    ball_form : BallForm
        The same in balls.
    working : tuple of int
        Independent rows.
    """

    def __init__(self, form: ExactForm, ball_form: BallForm, working: tuple[int, ...]) -> None:
        self.form = form
        self.ball_form = ball_form
        self.working = working
        self._implied: dict[int, bool] = {}

    def on(self, working: tuple[int, ...]) -> "Minimiser":
        """Return the minimiser of the same form on another working set."""
        return Minimiser(self.form, self.ball_form, working)

    @cached_property
    def equations(self) -> list[list[fmpz]]:
        """The equations [a, b] that x satisfies: those of the working set."""
        return self.form.equations(self.working)

    @cached_property
    def balls(self) -> BallSolution | None:
        """Balls around x, the multipliers and the slacks; None if they show nothing."""
        return equality_solution(self.ball_form, self.working)

    @cached_property
    def rational(self) -> RationalSolution:
        """The same without rounding: milliseconds, so only where it is needed."""
        return rational_solution(self.form, self.working)

    def lam_sign(self, j: int) -> int:
        """Return the exact sign of the multiplier of working[j]."""
        shown = None if self.balls is None else _ball_sign(self.balls.lam[j])
        return _sign(self.rational.lam[j]) if shown is None else shown

    def positive(self) -> tuple[int, ...]:
        """Return the rows of the working set whose multipliers are positive."""
        return tuple(i for j, i in enumerate(self.working) if self.lam_sign(j) > 0)

    def surely_positive(self) -> tuple[int, ...]:
        """Return the rows of the working set whose multipliers have balls above zero."""
        if self.balls is None:
            return ()
        return tuple(i for i, ball in zip(self.working, self.balls.lam, strict=True) if ball > 0)

    @cached_property
    def ball_slack_signs(self) -> list[int | None]:
        """Signs of all slacks as the balls show them: 1, -1, or None where they do not."""
        if self.balls is None:
            return [None] * self.form.m
        signs = [_ball_sign(ball) for ball in self.balls.slack]
        return [sign if sign else None for sign in signs]  # Zeros are decided by `spanned`.

    @cached_property
    def exact_slack_signs(self) -> list[int]:
        """Exact signs of all slacks."""
        signs = list(self.ball_slack_signs)
        for i in self.working:
            signs[i] = 0
        for i in self.spanned([i for i, sign in enumerate(signs) if sign is None]):
            signs[i] = 0
        return [_sign(self.rational.slack[i]) if s is None else s for i, s in enumerate(signs)]

    def spanned(self, rows: Sequence[int]) -> list[int]:
        """Return those of some rows whose slack is zero because the working set implies it."""
        new = [i for i in rows if i not in self._implied]
        if new:
            shown = follow(self.equations, self.form.equations(new))
            self._implied.update(zip(new, shown, strict=True))
        return [i for i in rows if self._implied[i]]

    def zero_coordinates(self, coordinates: Sequence[int]) -> list[int]:
        """Return those of some coordinates in which the working set implies that x is zero."""
        n = self.form.n
        units = [[fmpz(int(i == v)) for i in range(n + 1)] for v in coordinates]
        zero = follow(self.equations, units) if units else []
        return [v for v, is_zero in zip(coordinates, zero, strict=True) if is_zero]


def _sign(x: fmpz) -> int:
    return (x > 0) - (x < 0)


def _ball_sign(ball: arb) -> int | None:
    """Return the sign that a ball shows, or None."""
    if ball > 0:
        return 1
    if ball < 0:
        return -1
    return 0 if ball.is_zero() else None
