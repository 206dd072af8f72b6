"""A step in the ellipsoid as a conic program in units of about one, in high precision."""

from dataclasses import dataclass

import numpy as np
from flint import arb, arb_mat

from quasistatic_ref.exact.program import ExactProgram, exact_matrix
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.ellipsoid.impulses import ONE, cone_blocks
from quasistatic_ref.optional.ellipsoid.interior import Blocks, Pair, column, diagonal
from quasistatic_ref.optional.gap import inner, square_root
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import UNMOVED

NOTHING = arb(2) ** -10
"""Share of the deepest penetration below which a free step is no unit of the step [-]."""


@dataclass(frozen=True, eq=False)
class ScaledBlocks:
    """The program, and the factors that lead back to the exact form.

    Parameters
    ----------
    form : ExactProgram
    problem : Blocks
    mu : list of arb
        What each row of A is multiplied by: 1, mu_v, mu_v, mu_omega; 1 for own rows.
    root : list of arb
        Unit of each coordinate.
    length : list of arb
        Unit of each row: the largest absolute entry of its block; 1 if all are zero.
    give : list of arb
        What each row gives way by for each unit of y.
    least : arb
        The length that errors are divided by (certify/norm.py) but for ||x*||_H, in the form's H.
    size : arb
        Unit of the step: ||H^-1 g||_H, or the largest gap in units of `length` where g is next to
        nothing; 1 if all gaps are zero, too.
    """

    form: ExactProgram
    problem: Blocks
    mu: list[arb]
    root: list[arb]
    length: list[arb]
    give: list[arb]
    least: arb
    size: arb

    def in_form(self, pair: Pair) -> Pair:
        """A pair of the scaled program as x and y of the exact form."""
        x = [self.size * r * v for r, v in zip(self.root, pair.x.entries(), strict=True)]
        y = [self.size / ell * v for ell, v in zip(self.length, pair.y.entries(), strict=True)]
        return Pair(column(x), column(y))

    def start(self, delta_q: Array, lam: Array) -> Pair:
        """An answer in SI units, delta_q (n_v,) and lam (m,), as a pair of the program."""
        form = self.form
        x = [arb(v) / (self.size * r) for r, v in zip(self.root, delta_q.tolist(), strict=True)]
        y = [
            arb(v) * ell * form.h / (self.size * mu) if mu > 0 else arb(0)
            for mu, ell, v in zip(self.mu, self.length, lam.tolist(), strict=True)
        ]
        return Pair(column(x), column(y))


def scaled_blocks(step: StepData, form: ExactProgram, compliance: float = 0.0) -> ScaledBlocks:
    """The conic program of a step in the ellipsoid.

    Parameters
    ----------
    step : StepData
    form : ExactProgram
        That of the step.
    compliance : float
        Of each contact [m/N]; the user's rows are rigid.
    """
    H = form.H
    free_step = form.H_inverse * form.g
    blocks = [rows for _, rows, _ in cone_blocks(step)]
    mu = [arb(v) for _, _, c in cone_blocks(step) for v in (ONE, *c)]
    root = [(1 / arb(H[v, v]).sqrt()).mid() for v in range(form.n)]
    A = scaled(form.A, mu, root)
    entries = A.entries()
    length = []
    for rows in blocks:
        ell = largest(entries[rows.start * form.n : rows.stop * form.n])
        length += [ell] * len(rows)
    gaps = [form.c[rows[0], 0] / length[rows[0]] for rows in blocks]
    free = square_root(inner(free_step, H * free_step))
    deepest = max((-gap for gap in gaps if gap < 0), default=arb(0))
    size = free.mid() if free > NOTHING * deepest else largest(gaps)
    alone = [square_root(inner(p, form.H_inverse * p)) for p in exact_loads(step, form)]
    unmoved = arb(UNMOVED) * min((arb(H[v, v]).sqrt() for v in range(form.n)), default=arb(0))
    least = max(one.lower() for one in (free, *alone, unmoved))
    of_contacts = 4 * step.contacts.n_c
    soft = arb(compliance) / step.h / form.h
    give = [soft] * of_contacts + [arb(0)] * (form.m - of_contacts)
    shares = [1 / ell for ell in length]
    problem = Blocks(
        H=scaled(H, root, root).mid(),
        g=scaled(form.g, root, [1 / size]).mid(),
        A=scaled(A, shares, [arb(1)] * form.n).mid(),
        b=scaled(scaled(-form.c, mu, [arb(1)]), shares, [1 / size]).mid(),
        C=diagonal([c / ell**2 for c, ell in zip(give, length, strict=True)]).mid(),
        rows=blocks,
    )
    return ScaledBlocks(form, problem, mu, root, length, give, least, size)


def scaled(matrix: arb_mat, rows: list[arb], columns: list[arb]) -> arb_mat:
    """A matrix, (k, n), whose rows and columns are multiplied by numbers [its unit]."""
    both = zip(rows, matrix.tolist(), strict=True)
    return arb_mat([
        [r * v * c if v else v for v, c in zip(row, columns, strict=True)] for r, row in both
    ]) if rows else matrix  # fmt: skip


def exact_loads(step: StepData, form: ExactProgram) -> list[arb_mat]:
    """What targets, tau_a, tau_u and a cost each add to g, (n, 1) [N s, N m s], times h."""
    n_a = step.n_a
    K_q = np.zeros((form.n, form.n))
    K_q[:n_a, :n_a] = step.K_q
    columns = np.zeros((4, form.n, 1))
    columns[0, :n_a, 0] = step.delta_q_bar_a
    columns[1, :n_a, 0] = step.tau_a
    columns[2, n_a:, 0] = step.tau_u
    if step.extra.cost is not None:
        columns[3, :, 0] = step.extra.cost[1]
    shift, tau_a, tau_u, pull = map(exact_matrix, columns)
    h = form.h
    return [exact_matrix(K_q) * shift * (h * h), tau_a * (h * h), tau_u * (h * h), pull * h]


def largest(values: list[arb]) -> arb:
    """The largest absolute value of some numbers [of their unit]; 1 if all are zero, or none."""
    most = max((abs(v).mid() for v in values), default=arb(0))
    return most if most > 0 else arb(1)
