r"""How far H, g, A, b and their products in float64 may be from those of the exact step.

A sum of products, in any order, with at most D roundings from each of its numbers to the result,
is off by at most :math:`\gamma_D = D u / (1 - D u)` times the sum of the sizes of its terms
(u = 2^-53). That sum is formed in float64 too, in at most D roundings, so that it is too small by
a factor of :math:`1 - \gamma_D` at most. What underflows is off by TINY at most.
"""

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.outward import above
from quasistatic_ref.optional.large.sparse_form import in_blocks
from quasistatic_ref.step.cones import cone_matrix
from quasistatic_ref.step.data import Array, Indices, Mask, StepData

UNIT = 2.0**-53
"""Largest relative error of one operation."""

ROUNDINGS = 10
"""Roundings from a number of the step to a result, beyond one for each term of the longest sum.

The sizes of H x - g - A'lam have most: with c rows of A in a column, the sums over these rows and
their contacts together c at most, mu (1), axes (3), J' (4), and two sums with H x and g (2)."""

LARGEST = 2.0**100
"""Numbers in natural units beyond it are given no bound."""

TINY = 2.0**-604
"""2^70 underflows of 2^-1074 each, times four numbers of LARGEST."""


def rounding(terms: int, sizes: Array) -> Array:
    """What sums of so many terms may be off by, shape (k,), from their `sizes` (k,) [-]."""
    D = terms + ROUNDINGS
    part = D * UNIT / (1 - 2 * D * UNIT)  # gamma_D / (1 - gamma_D)
    return above(math.nextafter(part, math.inf) * sizes + TINY)


class TermSizes(Protocol):
    """What a bound of rounding needs to know of A, of any form: see :class:`Sizes`."""

    @property
    def load(self) -> Array:
        """Of g, shape (n_v,)."""

    @property
    def row_terms(self) -> int:
        """Most terms of a row."""

    @property
    def column_terms(self) -> int:
        """Most terms of a column."""

    @property
    def usable(self) -> bool:
        """Whether no number is beyond LARGEST."""

    def rows(self, x: Array) -> Array:
        """Of A x, shape (m,), from x (n_v,)."""

    def columns(self, lam: Array) -> Array:
        """Of A'lam, shape (n_v,), from lam >= 0 (m,)."""


@dataclass(frozen=True, eq=False)
class Sizes:
    """Sums of the sizes of all terms of A x, A'lam and g, in natural units.

    Parameters
    ----------
    blocks : Blocks
        Of the contacts; only sizes are taken of it.
    axes : ndarray, shape (n_c, 3, 3)
        Sizes of n, d1 and d2 [-].
    mu : ndarray, shape (n_c, 4)
        1, mu_v, mu_v and mu_omega [-, -, -, m].
    cone : ndarray, shape (R, 4)
        Sizes of what the rows combine [-].
    mask : ndarray of bool, shape (n_c, R)
        Which rows each contact has.
    coordinate : ndarray, shape (n_v,)
        Units of the coordinates over that of lengths, S / ell [1/m, rad/m].
    load : ndarray, shape (n_v,)
        Of g [-].
    row_terms, column_terms : int
        Most terms of a row of A, and of a column of A or a row of K_q.
    usable : bool
        Whether no number is beyond LARGEST.
    """

    blocks: Blocks
    axes: Array
    mu: Array
    cone: Array
    mask: Mask
    coordinate: Array
    load: Array
    row_terms: int
    column_terms: int
    usable: bool

    def rows(self, x: Array) -> Array:
        """Of A x, shape (m,), from x (n_v,)."""
        own = np.append(np.abs(x) * self.coordinate, 0.0)[self.blocks.column]
        motion = (np.abs(self.blocks.J) * own[:, None]).sum(axis=2)
        along = (self.axes * motion[:, None, :3]).sum(axis=2)
        four = np.concatenate([along, motion[:, 3:]], axis=1) * self.mu
        return np.asarray((four @ self.cone.T)[self.mask])

    def columns(self, lam: Array) -> Array:
        """Of A'lam, shape (n_v,), from lam >= 0 (m,)."""
        of_rows = np.zeros(self.mask.shape, dtype=lam.dtype)
        of_rows[self.mask] = lam
        four = (of_rows @ self.cone) * self.mu
        force = (self.axes * four[:, :3, None]).sum(axis=1)
        wrench = np.concatenate([force, four[:, 3:]], axis=1)
        own = (np.abs(self.blocks.J) * wrench[:, :, None]).sum(axis=1)
        whole = np.zeros(self.blocks.n_v + 1, dtype=own.dtype)
        np.add.at(whole, self.blocks.column, own)
        return np.asarray(whole[:-1] * self.coordinate)


def sizes_of(step: StepData, coordinate: Array, length: float, size: float) -> Sizes:
    """The sizes of a step whose contacts are in blocks, and whose cone has rows.

    Parameters
    ----------
    step : StepData
        SI units.
    coordinate : ndarray, shape (n_v,)
        Natural units S of the coordinates [m or rad, per (N m s)^0.5].
    length, size : float
        Natural units ell [m per (N m s)^0.5] and rho [(N m s)^0.5].
    """
    c = step.contacts
    blocks = in_blocks(step)
    of_load = coordinate / size
    spring = np.abs(step.K_q) @ np.abs(step.delta_q_bar_a)  # Eq. (1)
    load = np.concatenate([spring + np.abs(step.tau_a), np.abs(step.tau_u)]) * step.h
    sizes = Sizes(
        blocks=blocks,
        axes=np.abs(np.stack([c.n, c.d1, c.d2], axis=1)),
        mu=np.column_stack([np.ones(c.n_c), c.mu]),
        cone=np.abs(cone_matrix(step.cone)),
        mask=step.mask,
        coordinate=coordinate / length,
        load=load * of_load,
        row_terms=blocks.column.shape[1],
        column_terms=max(_most_rows(blocks, step.counts), step.n_a),
        usable=True,
    )
    largest = (blocks.J, sizes.mu, sizes.load, sizes.coordinate, of_load, coordinate)
    usable = step.h <= LARGEST
    usable = usable and all(float(np.abs(v).max(initial=0.0)) <= LARGEST for v in largest)
    return replace(sizes, usable=usable)


def _most_rows(blocks: Blocks, counts: Indices) -> int:
    """Most rows of A in which one coordinate moves."""
    rows = np.broadcast_to(counts[:, None], blocks.column.shape)
    of_coordinates = np.bincount(blocks.column.ravel(), rows.ravel(), minlength=blocks.n_v)
    return int(of_coordinates[: blocks.n_v].max(initial=0))
