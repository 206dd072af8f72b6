"""A step in the ellipsoid as a conic program in units of about one, in high precision."""

from dataclasses import dataclass

from flint import arb, arb_mat

from quasistatic_ref.certify.minimiser import BallForm, form_in_balls, inner, square_root
from quasistatic_ref.certify.rational import ExactForm
from quasistatic_ref.optional.ellipsoid.impulses import ONE, cone_blocks
from quasistatic_ref.optional.ellipsoid.interior import Blocks, Pair, column, diagonal
from quasistatic_ref.step.data import Array, StepData


@dataclass(frozen=True, eq=False)
class ScaledBlocks:
    """The program, and the factors that lead back to the units of the exact form.

    Parameters
    ----------
    form : ExactForm
    balls : BallForm
        The same in balls.
    problem : Blocks
    mu : list of arb
        What each row of A is multiplied by: 1, mu_v, mu_v, mu_omega; 1 for own rows.
    root : list of arb
        Unit of each coordinate.
    length : list of arb
        Unit of each row: the largest absolute entry of its block; 1 if all are zero.
    give : list of arb
        What each row gives way by for each unit of y, in the form's units.
    free : arb
        ||H^-1 g||_H.
    size : arb
        Unit of the step: `free`, or the largest gap in units of `length` if g is zero; 1 if all
        gaps are zero, too.
    """

    form: ExactForm
    balls: BallForm
    problem: Blocks
    mu: list[arb]
    root: list[arb]
    length: list[arb]
    give: list[arb]
    free: arb
    size: arb

    def in_form(self, found: Pair) -> Pair:
        """The x and y of a pair in the form's units; lam is `mu` times y."""
        x = [self.size * r * v for r, v in zip(self.root, found.x.entries(), strict=True)]
        y = [self.size / ell * v for ell, v in zip(self.length, found.y.entries(), strict=True)]
        return Pair(column(x), column(y))

    def start(self, delta_q: Array, lam: Array) -> Pair:
        """An answer in SI units, delta_q (n_v,) and lam (m,), as a pair of the program."""
        form = self.form
        x = [
            arb(v) / (form.x_unit * self.size * r)
            for r, v in zip(self.root, delta_q.tolist(), strict=True)
        ]
        y = [
            arb(v) * ell / (form.lam_unit * self.size * mu) if mu > 0 else arb(0)
            for mu, ell, v in zip(self.mu, self.length, lam.tolist(), strict=True)
        ]
        return Pair(column(x), column(y))


def scaled_blocks(step: StepData, form: ExactForm, compliance: float = 0.0) -> ScaledBlocks:
    """The conic program of a step in the ellipsoid.

    Parameters
    ----------
    step : StepData
    form : ExactForm
        That of the step.
    compliance : float
        Of each contact [m/N]; the user's rows are rigid.
    """
    balls = form_in_balls(form)
    H = arb_mat(form.H)
    blocks = [rows for _, rows, _ in cone_blocks(step)]
    mu = [arb(v) for _, _, c in cone_blocks(step) for v in (ONE, *c)]
    root = [(1 / arb(H[v, v]).sqrt()).mid() for v in range(form.n)]
    R = diagonal(root)
    M = diagonal(mu)
    A = M * balls.A * R
    entries = A.entries()
    length = []
    for rows in blocks:
        ell = largest(entries[rows.start * form.n : rows.stop * form.n])
        length += [ell] * len(rows)
    gaps = [balls.b[rows[0], 0] / length[rows[0]] for rows in blocks]
    free = square_root(inner(balls.x_free, H * balls.x_free))
    size = free.mid() if free > 0 else largest(gaps)
    of_contacts = 4 * step.contacts.n_c
    soft = arb(compliance) / step.h * form.lam_unit / form.slack_unit
    give = [soft] * of_contacts + [arb(0)] * (form.m - of_contacts)
    L = diagonal([1 / ell for ell in length])
    problem = Blocks(
        H=(R * H * R).mid(),
        g=(R * arb_mat(form.g) * (1 / size)).mid(),
        A=(L * A).mid(),
        b=(L * (M * balls.b) * (1 / size)).mid(),
        C=diagonal([c / ell**2 for c, ell in zip(give, length, strict=True)]).mid(),
        rows=blocks,
    )
    return ScaledBlocks(form, balls, problem, mu, root, length, give, free, size)


def largest(values: list[arb]) -> arb:
    """The largest absolute value of some numbers [of their unit]; 1 if all are zero, or none."""
    most = max((abs(v).mid() for v in values), default=arb(0))
    return most if most > 0 else arb(1)
