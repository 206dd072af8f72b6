"""One step from the mechanism to q+ in numbers of the grid.

H, g, A and b are those of the layer ``step``, but none of them is rounded to float64; the quadratic
program is solved by the exact method, from the working set of a step nearby.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import lcm

import numpy as np
from flint import arb_mat, fmpq, fmpz_mat

from quasistatic_ref.certify.active_set import Farkas, Optimum, dual_active_set
from quasistatic_ref.certify.form import MatrixForm
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program import candidates
from quasistatic_ref.lab.program.integration import integrate
from quasistatic_ref.lab.program.mechanism import contact_jacobian
from quasistatic_ref.lab.program.rotation import AXES
from quasistatic_ref.lab.program.rows import contact_rows
from quasistatic_ref.lab.program.step import objective
from quasistatic_ref.lab.vectors.exact.precision import Matrix, Real, Vector
from quasistatic_ref.lab.vectors.exact.rational import rationals
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.unrounded.grid import on_grid, working_precision
from quasistatic_ref.lab.vectors.unrounded.nearby import Near
from quasistatic_ref.lab.vectors.unrounded.world import World


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
class Solved:
    """A step, before (+).

    Parameters
    ----------
    H, g, A : ndarray
        Of the program [SI].
    form : MatrixForm
        Its cost and its rows times a number each.
    optimum : Optimum
    delta_q : vector
        On the grid [m, rad].
    """

    H: Matrix
    g: Vector
    A: Matrix
    form: MatrixForm
    optimum: Optimum
    delta_q: Vector


def contact(at: World, near: Near) -> Contact:
    """A contact in its frame."""
    with working_precision():
        d1 = on_grid(candidates.tangents(np.array(near.n))[0])
    d2 = on_grid(np.cross(near.n, d1))
    pair = at.case["pairs"][near.pair]
    bodies = {f"{s}_body": at.case["shapes"][pair[s]]["body"] for s in ("alpha", "beta")}
    J = contact_jacobian(at.at, {**vars(near), **bodies})
    motion = np.vstack([np.array([near.n, d1, d2]) @ J[:3], J[3:]])
    return Contact(near, d1, d2, on_grid(motion))


def rows(case: Json, contacts: Sequence[Contact]) -> tuple[list[Vector], list[Real]]:
    """A and b of the program; each entry is exact in the contacts' motion and phi."""
    A: list[Vector] = []
    b: list[Real] = []
    for one in contacts:
        own = dict(zip(("n", "d1", "d2"), AXES, strict=True)) | {"J": one.motion}
        block = contact_rows({**case["pairs"][one.near.pair], **own}, case["cone"])
        A.extend(block)
        b += [-one.near.phi] * len(block)
    return A, b


def step_solution(at: World, contacts: Sequence[Contact], warm: Sequence[int] = ()) -> Solved:
    """delta_q of a step with these contacts.

    Parameters
    ----------
    at : World
    contacts : sequence of Contact
    warm : sequence of int
        Rows of A that are likely active; any will do.

    Raises
    ------
    InputError
        If the step has no solution.
    """
    with working_precision():
        H, g = map(on_grid, objective(at.case, *at.loads))
    rows_of, limits = rows(at.case, contacts)
    A = np.array(rows_of, dtype=object).reshape(len(limits), len(g))
    form = form_of(H, g, A, np.array(limits, dtype=object))
    optimum = dual_active_set(form, warm)
    if isinstance(optimum, Farkas):
        raise InputError("the step has no solution", field="pairs")
    return Solved(H, g, A, form, optimum, delta_q(optimum))


def delta_q(optimum: Optimum) -> Vector:
    """The displacement of an optimum, on the grid [m, rad]."""
    return on_grid(rationals(optimum.minimiser.fractions.point))


def form_of(H: Matrix, g: Vector, A: Matrix, b: Vector) -> MatrixForm:
    """The program min 1/2 x'Hx - g'x s.t. A x >= b, its cost and its rows times a number each."""
    cost = _integers(np.column_stack([H, g])).tolist()
    quadratic = arb_mat([row[:-1] for row in cost])
    linear = arb_mat([row[-1:] for row in cost])
    return MatrixForm(quadratic, linear, arb_mat(_integers(np.column_stack([A, -b]))))


def _integers(A: Matrix) -> fmpz_mat:
    factor = lcm(*(int(x.q) for x in map(fmpq, A.ravel())))
    return fmpz_mat(len(A), A.shape[1], [int((x * factor).p) for x in map(fmpq, A.ravel())])


def after(at: World, step: Sequence[Real]) -> Vector:
    """Configuration q (+) delta_q; balls where it is not rational."""
    with working_precision():
        case = {"mechanism": at.case["mechanism"], "q": at.case["q"], "delta_q": step}
        found: Vector = integrate(case)["q"]
        return found
