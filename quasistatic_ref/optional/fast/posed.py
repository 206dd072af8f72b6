"""Steps as a simulator poses them: right by construction, and so not checked number by number.

What a user changes of them, through ``replace``, is checked.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple, TypeVar

import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.step.arrays import (
    Array,
    Indices,
    checked_array,
    whole,
)
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import (
    Extra,
    RowLayout,
    StepData,
    hessian,
    hessian_blocks,
    no_rows,
    row_layout,
    seconds,
)
from quasistatic_ref.step.pivots import positive_definite

T = TypeVar("T", bound=Plain)


class Constants(NamedTuple):
    """What the steps of a simulator have in common, checked and formed once.

    Parameters
    ----------
    h : float
        Time step [s].
    cone : str
    K_q, M_u : ndarray, shapes (n_a, n_a) and (n_u, n_u)
        As in :class:`~quasistatic_ref.step.data.StepData`; of many bodies M_u is kept in diagonal
        blocks, shape (n_u / 6, 6, 6).
    extra : Extra
        No rows of a user's own.
    H : ndarray, shape (n_v, n_v)
        Of Eq. :eq:`eq-13`; where M_u is in blocks, these blocks over h and nothing else.
    row_layout : RowLayout
    """

    h: float
    cone: str
    K_q: Array
    M_u: Array
    extra: Extra
    H: Array
    row_layout: RowLayout

    @property
    def kind(self) -> type[StepData]:
        """The class of the steps, which keep M_u as it is kept here."""
        return StepData if self.M_u.ndim == 2 else BlockStep

    def fields(self) -> dict[str, object]:
        """What the steps keep of it, by name."""
        own = self._asdict()
        if self.kind is BlockStep:
            own["blocks"] = own.pop("M_u")
        return own

    def at(self, M_u: Array) -> "Constants":
        """The same with the M_u, shape (n_u, n_u) [kg, kg m^2], of another configuration.

        Raises
        ------
        StepDataError
            If M_u is not positive definite.
        """
        if M_u is self.M_u:
            return self
        positive_definite("M_u", M_u)
        return self._replace(M_u=M_u, H=hessian(self.h, self.K_q, M_u))


def constants(
    h: float, K_q: Array, n_a: int, M_u: Array, rows: Indices, cone: str = PYRAMID
) -> Constants:
    """The constants of steps of n_c contacts with `rows`, shape (n_c,); M_u whole or in blocks.

    Raises
    ------
    StepDataError
        If h is not positive, or K_q or M_u not symmetric positive definite.
    """
    n_u = math.prod(M_u.shape[:-1])
    h = seconds(h)
    K_q = positive_definite("K_q", checked_array(K_q, "K_q", (n_a, n_a)))
    try:
        positive_definite("M_u", checked_array(M_u, "M_u", M_u.shape))  # all blocks in one call
    except StepDataError:
        every_block = checked_array(whole(M_u), "M_u", (n_u, n_u))
        positive_definite("M_u", every_block)  # whose sentence shows all of M_u
    layout = row_layout(cone, rows.tobytes())
    H = hessian(h, K_q, M_u) if M_u.ndim == 2 else hessian_blocks(h, K_q, M_u)[1]
    return Constants(h, cone, K_q, M_u, no_rows(n_a + n_u), H, layout)


class BlockStep(StepData):
    """A step of a simulator of many bodies, whose M_u is kept in diagonal blocks.

    Attributes
    ----------
    blocks : ndarray, shape (n_u / 6, 6, 6)
        The diagonal blocks of M_u [kg, kg m, kg m^2].
    """

    blocks: Array

    @classmethod
    def kept(cls) -> tuple[str, ...]:
        """As of any step, with the blocks in the place of M_u."""
        return tuple("blocks" if name == "M_u" else name for name in super().kept())

    @classmethod
    def compared_as(cls) -> type:
        """It is compared as :class:`~quasistatic_ref.step.data.StepData`."""
        return StepData

    @property
    def kept_M_u(self) -> Array:
        """The diagonal blocks of M_u, shape (n_u / 6, 6, 6)."""
        return self.blocks

    @property
    def M_u(self) -> Array:
        """All of M_u, shape (n_u, n_u): formed whenever it is read, and not kept."""
        return whole(self.blocks)

    @property
    def H(self) -> Array:
        """All of H of Eq. :eq:`eq-13`, shape (n_v, n_v): formed whenever it is read, too."""
        return hessian(self.h, self.K_q, self.M_u)

    def inertia(self, u: Indices) -> Array:
        """M_u of some un-actuated coordinates, (k,), counted from the first: shape (k, k)."""
        blocks = self.blocks
        block, place = np.divmod(u, blocks.shape[-1])
        entries = blocks[block[:, None], place[:, None], place]
        return np.where(block[:, None] == block, entries, 0.0)

    def coupled(self) -> tuple[Indices, Indices]:
        """Both coordinates of each entry below the diagonal of K_q or M_u that is not zero."""
        blocks = self.blocks
        block, one, other = np.nonzero(np.tril(blocks, -1))
        first = self.n_a + blocks.shape[-1] * block
        of_a, with_a = np.nonzero(np.tril(self.K_q, -1))
        return np.concatenate([of_a, first + one]), np.concatenate([with_a, first + other])

    def momentum(self, delta_q: Array) -> Array:
        """M_u delta_q_u, shape (..., n_u) [kg m, kg m^2], of delta_q, shape (..., n_v) [m, rad]."""
        moved = delta_q[..., self.n_a :]
        blocks = self.blocks
        momentum = blocks @ moved.reshape(*moved.shape[:-1], *blocks.shape[:-1], 1)
        return momentum.reshape(moved.shape)


def posed(kind: type[T], same: Mapping[str, object], own: Mapping[str, object]) -> T:
    """Data of a `kind`, unchecked: of fields that are the `same` at each step, and of their `own`.

    The arrays must be read-only; they are not copied.
    """
    made = kind.__new__(kind)
    made.__setstate__(({**same, **own}, []))  # as a copy gets its fields
    return made
