"""A step in the ellipsoid as a conic program in units of about one, in high precision."""

from dataclasses import dataclass

from flint import arb, arb_mat

from quasistatic_ref.certify.minimiser import BallForm, inner, square_root
from quasistatic_ref.certify.rational import ExactForm
from quasistatic_ref.optional.ellipsoid.impulses import ONE, cone_blocks
from quasistatic_ref.optional.ellipsoid.interior import Blocks, Pair, Vector
from quasistatic_ref.step.data import Array, StepData


@dataclass(frozen=True, eq=False)
class ScaledBlocks:
    """The program, and the factors that lead back to the units of the exact form.

    Parameters
    ----------
    problem : Blocks
    blocks : list of range
        The rows of A of each contact, then one block for each row of the user's own.
    mu : list of arb
        What each row of A is multiplied by: 1, mu_v, mu_v, mu_omega; 1 for own rows.
    root : list of arb
        Unit of each coordinate.
    length : list of arb
        Unit of the rows of each block: their largest absolute entry; 1 if all are zero.
    give : list of arb
        What each block gives way by for each unit of y, in the form's units.
    size : arb
        Unit of the step: ||H^-1 g||_H, or the largest gap in units of `length` if g is zero; 1 if
        all gaps are zero, too.
    """

    problem: Blocks
    blocks: list[range]
    mu: list[arb]
    root: list[arb]
    length: list[arb]
    give: list[arb]
    size: arb

    def pair(self, found: Pair) -> tuple[arb_mat, list[Vector]]:
        """The x and y of a pair in the form's units, without radius; lam is `mu` times y."""
        scaled = [self.size * r * v for r, v in zip(self.root, found.x.entries(), strict=True)]
        along = zip(self.length, found.y, strict=True)
        y = [[(self.size / ell * v).mid() for v in y_j] for ell, y_j in along]
        return arb_mat(len(scaled), 1, scaled).mid(), y

    def start(self, form: ExactForm, delta_q: Array, lam: Array) -> tuple[arb_mat, list[Vector]]:
        """An answer in SI units, delta_q (n_v,) and lam (m,), as x and y of the program."""
        coordinates = zip(self.root, delta_q.tolist(), strict=True)
        x = [(arb(v) / (form.x_unit * self.size * r)).mid() for r, v in coordinates]
        y = [
            [(arb(lam[i]) * ell / (form.lam_unit * self.size * self.mu[i])).mid()
             if self.mu[i] > 0 else arb(0) for i in block]
            for ell, block in zip(self.length, self.blocks, strict=True)
        ]  # fmt: skip
        return arb_mat(len(x), 1, x), y


def scaled_blocks(
    step: StepData, form: ExactForm, balls: BallForm, compliance: float = 0.0
) -> ScaledBlocks:
    """The conic program of a step in the ellipsoid.

    Parameters
    ----------
    step : StepData
    form : ExactForm
        That of the step.
    balls : BallForm
        That of the form.
    compliance : float
        Of each contact [m/N]; the user's rows are rigid.
    """
    n = form.n
    A = balls.A
    b = balls.b
    mu = [arb(v) for _, _, c in cone_blocks(step) for v in (ONE, *c)]
    blocks = [rows for _, rows, _ in cone_blocks(step)]
    root = [(1 / arb(form.H[v, v]).sqrt()).mid() for v in range(n)]
    rows = [[[mu[i] * A[i, v] * root[v] for v in range(n)] for i in block] for block in blocks]
    length = [largest([a for row in block for a in row]) for block in rows]
    gaps = [abs(b[block[0], 0]) / ell for block, ell in zip(blocks, length, strict=True)]
    free = square_root(inner(balls.x_free, arb_mat(form.H) * balls.x_free))
    size = free.mid() if free > 0 else largest(gaps)
    n_c = step.contacts.n_c
    soft = arb(compliance) / step.h * form.lam_unit / form.slack_unit
    give = [soft] * n_c + [arb(0)] * (len(blocks) - n_c)
    problem = Blocks(
        H=arb_mat(
            n, n, [root[u] * form.H[u, v] * root[v] for u in range(n) for v in range(n)]
        ).mid(),
        g=arb_mat(n, 1, [root[v] * form.g[v, 0] / size for v in range(n)]).mid(),
        A=[
            arb_mat(len(block), n, [a / ell for row in block for a in row]).mid()
            for block, ell in zip(rows, length, strict=True)
        ],
        b=[
            arb_mat(len(block), 1, [mu[i] * b[i, 0] / (ell * size) for i in block]).mid()
            for block, ell in zip(blocks, length, strict=True)
        ],
        give=[(c / ell**2).mid() for c, ell in zip(give, length, strict=True)],
    )
    return ScaledBlocks(problem, blocks, mu, root, length, give, size)


def largest(values: list[arb]) -> arb:
    """The largest absolute value of some numbers [of their unit]; 1 if all are zero, or none."""
    most = max((abs(v).mid() for v in values), default=arb(0))
    return most if most > 0 else arb(1)
