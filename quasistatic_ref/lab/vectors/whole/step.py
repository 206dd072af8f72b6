"""One step from the mechanism to q+ in numbers of the grid.

H, g, A and b are those of the layer ``step``, but none of them is rounded to float64; the quadratic
program is solved by the exact method in integers, from the working set of a step nearby.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from math import lcm
from typing import Final, TypeAlias

from flint import arb, arb_mat, ctx, fmpq, fmpz_mat

from quasistatic_ref.certify.active_set import Farkas, Optimum, dual_active_set
from quasistatic_ref.certify.rational import ExactForm
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.exact.algebra import Matrix, Vector, cross, dot, subtract, unit
from quasistatic_ref.lab.vectors.exact.integration import integrated
from quasistatic_ref.lab.vectors.exact.precision import Real, number, numbers
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers.rows import row_count
from quasistatic_ref.lab.vectors.layers.step import objective_of
from quasistatic_ref.lab.vectors.whole.grid import (
    matrix_on_grid,
    on_grid,
    vector_on_grid,
    working,
)
from quasistatic_ref.lab.vectors.whole.nearby import Near
from quasistatic_ref.lab.vectors.whole.world import World
from quasistatic_ref.step.cones import cone_matrix

WIDE: Final = 1024
"""Bits of a ball on the way to delta_q: data of the grid have 400 and more."""
NARROW: Final = arb(2) ** -340
"""Radius of a ball whose middle is on the grid what the number itself is [m, rad]."""


@dataclass(frozen=True, eq=False)
class Contact:
    """A contact that is kept, and its motion per unit of delta_q.

    Parameters
    ----------
    near : Near
        Where it is.
    d1, d2 : vector
        Tangents.
    motion : list of vector
        Along n, d1, d2 and about n: 4 rows of n_v numbers.
    """

    near: Near
    d1: Vector
    d2: Vector
    motion: Matrix


@dataclass(frozen=True, eq=False)
class Rows:
    """A x >= b in integers: both sides times the denominator, b in rational numbers yet.

    Parameters
    ----------
    A : fmpz_mat
    denominator : int
    b : vector
    """

    A: fmpz_mat
    denominator: int
    b: Vector


@dataclass(frozen=True, eq=False)
class Solved:
    """A step, before (+).

    Parameters
    ----------
    form : ExactForm
    rows : Rows
    optimum : Optimum
    delta_q : vector
        On the grid [m, rad].
    """

    form: ExactForm
    rows: Rows
    optimum: Optimum
    delta_q: Vector


Change: TypeAlias = Callable[[World, Near], Near]
"""A mistake: from a contact to what it is taken for."""


def tangents(n: Vector) -> tuple[Vector, Vector]:
    """Tangents d1 and d2 = n x d1, of the world's axis of the least |n_i|, the first of equals."""
    axis = min(range(3), key=lambda i: (abs(n[i]), i))
    e = [fmpq(int(i == axis)) for i in range(3)]
    with working():
        d1 = vector_on_grid(unit(subtract(e, [n[axis] * x for x in n])))
    return d1, vector_on_grid(cross(n, d1))


def contact(at: World, near: Near) -> Contact:
    """A contact in its frame."""
    d1, d2 = tangents(near.n)
    pair, n_v = at.case["pairs"][near.pair], at.tree.n_v
    motion = [[fmpq(0)] * n_v for _ in range(4)]
    for side, factor in (("beta", 1), ("alpha", -1)):
        body = at.tree.number(at.case["shapes"][pair[side]]["body"])
        for v, (nu, w) in at.at.point_columns(body, getattr(near, side)).items():
            moves = dot(near.n, nu), dot(d1, nu), dot(d2, nu), dot(near.n, w)
            for row, x in zip(motion, moves, strict=True):
                row[v] += factor * x
    return Contact(near, d1, d2, matrix_on_grid(motion))


def rows(case: Json, contacts: Sequence[Contact]) -> tuple[Matrix, Vector]:
    """A and b of the program; each entry is exact in the contacts' motion and phi."""
    A, b = [], []
    for one in contacts:
        pair, n_v = case["pairs"][one.near.pair], len(one.motion[0])
        mu_v, mu_omega = number(pair["mu_v"]), number(pair["mu_omega"])
        mu = (mu_v, mu_v, mu_omega if pair["rows"] == 6 else fmpq(0))
        for t in _table(case["cone"])[: row_count(case["cone"], pair["rows"])]:
            factors = [fmpq(1), *(m * x for m, x in zip(mu, t, strict=True))]
            used = [(x, row) for x, row in zip(factors, one.motion, strict=True) if x]
            A.append([sum((x * row[v] for x, row in used), fmpq(0)) for v in range(n_v)])
            b.append(-one.near.phi)
    return A, b


@cache
def _table(name: str) -> list[Vector]:
    """The rows t of a cone, as float64 writes them."""
    return [numbers(row) for row in cone_matrix(name)[:, 1:].tolist()]


def solved(
    at: World,
    contacts: Sequence[Contact],
    warm: Sequence[int] = (),
    known: Rows | None = None,
) -> Solved:
    """delta_q of a step with these contacts.

    Parameters
    ----------
    at : World
    contacts : sequence of Contact
    warm : sequence of int
        Rows of A that are likely active; any will do.
    known : Rows, optional
        The rows of these contacts.

    Raises
    ------
    InputError
        If the step has no solution.
    """
    with working():
        terms = objective_of(at.tree, at.at, at.case, at.loads)
        H, g = matrix_on_grid(terms["H"]), list(terms["g"])
        h = number(at.case["h"])
        for v, force in enumerate(at.case.get("tau", [])):
            g[v] += h * force
        g = vector_on_grid(g)
    own = known or integer_rows(len(g), *rows(at.case, contacts))
    form = form_of(H, g, own)
    optimum = dual_active_set(form, warm)
    if isinstance(optimum, Farkas):
        raise InputError("the step has no solution", field="pairs")
    return Solved(form, own, optimum, delta_q(form, optimum))


def delta_q(form: ExactForm, optimum: Optimum) -> Vector:
    """The displacement of an optimum, on the grid [m, rad]."""
    near = _in_balls(form, optimum.point.working)
    if near is not None:
        return near
    found = optimum.point.rational
    return [on_grid(form.x_unit * fmpq(x, found.denominator)) for x in found.x]


def _in_balls(form: ExactForm, working: Sequence[int]) -> Vector | None:
    """The same from balls, a tenth of the time; None if they are too wide for the grid."""
    n, W = form.n, len(working)
    with ctx.workprec(WIDE):
        A = arb_mat(W, n, [form.A[i, v] for i in working for v in range(n)])
        b = arb_mat(W, 1, [form.b[i, 0] for i in working])
        try:
            across = arb_mat(form.H).solve(A.transpose())
            alone = arb_mat(form.H).solve(arb_mat(form.g))
            lam = (A * across).solve(b - A * alone) if W else arb_mat(0, 1)
        except ZeroDivisionError:
            return None
        x = [value * form.x_unit for value in (alone + across * lam).entries()]
        if any(value.rad() > NARROW for value in x):
            return None
        return [on_grid(value) for value in x]


def integer_rows(n: int, A: Matrix, b: Vector) -> Rows:
    """The rows of a program of n unknowns in integers."""
    denominator = _denominator([x for row in A for x in row])
    return Rows(_integers(A, n, denominator), denominator, b)


def form_of(H: Matrix, g: Vector, rows: Rows) -> ExactForm:
    """The program min 1/2 x'Hx - g'x s.t. A x >= b in integers."""
    dH, dA = _denominator([x for row in H for x in row]), rows.denominator
    D = _denominator([*(x * dH for x in g), *(x * dA for x in rows.b)])
    return ExactForm(
        H=_integers(H, len(g), dH),
        g=_integers([[x] for x in g], 1, dH * D),
        A=rows.A,
        b=_integers([[x] for x in rows.b], 1, dA * D),
        x_unit=fmpq(1, D),
        slack_unit=fmpq(1, dA * D),
        lam_unit=fmpq(dA, dH * D),
        net_unit=fmpq(1, dH * D),
    )


def _denominator(values: Vector) -> int:
    return lcm(*(int(x.q) for x in values)) if values else 1


def _integers(A: Matrix, columns: int, factor: int) -> fmpz_mat:
    return fmpz_mat(len(A), columns, [int((x * factor).p) for row in A for x in row])


def after(at: World, step: Sequence[Real]) -> Vector:
    """Configuration q (+) delta_q; balls where it is not rational."""
    with working():
        return integrated(at.tree, at.case["q"], step)
