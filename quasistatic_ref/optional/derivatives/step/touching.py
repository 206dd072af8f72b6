r"""Which rows touch at an optimum, and which of them bear load, in float64.

The exact working set has the signs of one optimum, but rounding has split ties of float64
data. A row *touches* if its slack is not more than rounding of what it is a sum of, and *bears* if
its multiplier is more than that in some optimal lam: as a displacement in the H norm, relative to
the step.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.optimize import nnls

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.derivatives.tolerances import DEPENDENT, SPLIT
from quasistatic_ref.optional.friction import cone_matrix, scaled_by
from quasistatic_ref.step.friction import frame_jacobian, impulses
from quasistatic_ref.step.standard_form import linear_term
from quasistatic_ref.tolerances import FILLED

TOUCHING: Final = 1e-14
"""Slack of a row, relative to the numbers that it is a sum of, at which it counts as none where a
derivative is computed [-]: some fifty roundings of 2e-16."""

BEARING: Final = 1e-11
"""Multiplier of a row at which it counts as none where a derivative is computed: the displacement
that it causes over that of the step, in the H norm [-]. That is the rounding of places, 1e-16 m,
over a step of 1e-5 m."""

SHARE: Final = 1e-3
"""Of what all rows exert, what a row is tried to bear [-]: so much more than rounding that what
misses is known to nine digits, and so little that the other rows are those that bear."""

SHARES = 20
"""Most shares that a row is tried to bear; one or two are usual."""


@dataclass(frozen=True, eq=False)
class Touching:
    """The rows without slack at an optimum.

    Parameters
    ----------
    inverse : ndarray, shape (n_v, n_v)
        Of the Cholesky factor L of H [unit of delta_q per (N m s)^0.5].
    generators : ndarray, shape (n_c, 4, n_v)
        J_n, mu_v J_1, mu_v J_2 and mu_omega J_w, which the rows combine [m].
    table : ndarray, shape (R, 4)
        How the cone's rows combine them [-].
    strict, idle : ndarray of int, shape (k, 2)
        Contact and row of those that bear load in some optimal lam, and of the others.
    impulses : ndarray, shape (n_c, R)
        The multiplier of each row in an optimal lam [N s]; 0 where a contact lacks it.
    open : ndarray of int, shape (k, 2)
        Contact and row of those that do not touch.
    slack : ndarray, shape (k,)
        Theirs [m].
    """

    inverse: Array
    generators: Array
    table: Array
    strict: Indices
    idle: Indices
    impulses: Array
    open: Indices
    slack: Array

    @property
    def multipliers(self) -> Array:
        """What the impulses make of the generators, shape (n_c, 4) [N s]."""
        return self.impulses @ self.table

    @property
    def contacts(self) -> set[int]:
        """The contacts that touch."""
        return {int(j) for j, _ in (*self.strict, *self.idle)}

    def unloaded(self, some: Indices) -> "Touching":
        """The same where some rows, shape (k, 2), touch without load."""
        strict, open_ = (~_among(rows, some) for rows in (self.strict, self.open))
        idle = np.concatenate([self.idle, some[~_among(some, self.idle)]])
        return replace(
            self, strict=self.strict[strict], idle=idle,
            open=self.open[open_], slack=self.slack[open_],
        )  # fmt: skip

    def rows(self, some: Indices) -> Array:
        """Some rows of A, shape (k, n_v) [m], by contact and row (k, 2)."""
        return np.asarray((self.table @ self.generators)[tuple(some.T)])


def _among(rows: Indices, some: Indices) -> Mask:
    """Which rows, shape (k, 2), are among some."""
    return np.asarray((rows[:, None] == some).all(axis=2).any(axis=1))


def touching_rows(solution: StepSolution, places: Array) -> Touching:
    """The rows that touch at the certified optimum of a step in a polyhedral cone.

    Parameters
    ----------
    solution : StepSolution
    places : ndarray, shape (n_c,)
        How far the closest points are from the world's origin [m]: how large the numbers are whose
        rounding is in phi.

    Returns
    -------
    Touching
    """
    step = solution.step
    contacts = step.contacts
    table = cone_matrix(step.cone)
    parts = np.stack(frame_jacobian(contacts, contacts.J), axis=1)
    generators = parts * scaled_by(contacts)[:, :, None]
    x = solution.delta_q
    lam = solution.lam[: step.offsets[-1]]
    moved = generators @ x
    moved[:, 0] += contacts.phi
    slack = (moved @ table.T)[step.mask]
    terms = np.abs(generators) @ np.abs(x)
    terms[:, 0] += np.abs(contacts.phi) + places
    touches = slack <= TOUCHING * (terms @ np.abs(table).T)[step.mask]
    touches |= lam > 0

    L = np.asarray(np.linalg.cholesky(step.H), dtype=np.float64)
    inverse = np.asarray(np.linalg.inv(L), dtype=np.float64)
    every = np.argwhere(step.mask)
    phi = contacts.phi[every[:, 0]]
    unit, length = unit_rows((table @ generators)[step.mask] @ inverse.T)
    load_size = np.linalg.norm(inverse @ linear_term(step))
    step_size = np.linalg.norm(L.T @ x)
    size = float(max(load_size, step_size))
    if not size and len(every):  # nothing moves: what the nearest contact is away
        size = float((np.abs(phi) / length).min())
    Z = every[touches]
    bears = bearing(unit[touches], (lam * length)[touches], size)
    of_rows = impulses(contacts, lam, step.cone)
    away = ~touches & (phi < FILLED)
    return Touching(
        inverse, generators, table, Z[bears], Z[~bears], of_rows, every[away], slack[away]
    )


def unit_rows(rows: Array) -> tuple[Array, Array]:
    """Rows (k, n) of length one, and their lengths (k,) [of rows]; of a zero row, zero and 1."""
    length = np.linalg.norm(rows, axis=1)
    length[length == 0] = 1.0
    return rows / length[:, None], length


def bearing(rows: Array, lam: Array, size: float) -> Mask:
    """Which of some unit rows bear load in some optimal lam, shape (k,).

    Parameters
    ----------
    rows : ndarray, shape (k, n)
        Of length one [-].
    lam : ndarray, shape (k,)
        One optimal lam.
    size : float
        Size of the step, to which multipliers are compared [of lam]; 0 where nothing loads it.
    """
    bears: Mask = lam > BEARING * size
    if bears.all():
        return bears
    size = size or 1.0  # where nothing loads the step, rows may press against each other
    held = rows[bears]
    if len(held):  # what others span can take from them
        _, s, V = np.linalg.svd(held, full_matrices=False)
        V = V[s > DEPENDENT * s[0]]
        bears |= np.linalg.norm(rows - rows @ V.T @ V, axis=1) <= DEPENDENT
    net = rows.T @ lam / size
    for e in np.flatnonzero(~bears):
        if bears[e]:
            continue
        bears |= _most(rows, net, int(e)) > BEARING
    return bears


def _most(rows: Array, net: Array, e: int) -> Array:
    """An optimal lam, shape (k,), in which the row e bears, if it can; else zeros.

    All in units of the step's size. The row bears a share if the others can exert the rest. If they
    cannot, what misses, r, has no positive product with a row, and so no optimal lam has more in e
    than r.net / r.a_e: that share is tried next.
    """
    size = float(np.linalg.norm(net))
    share = max(SHARE * size, 2 * BEARING)
    for _ in range(SHARES):
        rest = net - share * rows[e]
        lam, miss = nnls(rows.T, rest)
        if miss <= SPLIT * max(size, share):
            lam[e] += share
            return np.asarray(lam)
        r = rest - rows.T @ lam
        share = float(r @ net / (r @ rows[e]))
        if share <= BEARING:
            break
    return np.zeros(len(rows))
