"""What may touch what, and how rough it is. The user's contact numbers live here, nowhere else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.shapes import PlacedShape, PointCloud
from quasistatic_ref.step.data import Array


@dataclass(frozen=True, eq=False)
class ContactPair:
    """Two shapes that may touch.

    Parameters
    ----------
    name : str
    alpha, beta : PlacedShape
        The normal points from alpha's body to beta's; the wrench acts on beta's.
    mu_v : float
        Tangential friction coefficient [-], >= 0.
    mu_omega : float
        Torsional friction coefficient, a length [m], >= 0.
    rows : int
        6, or 4 for contacts without torsion.
    k : int
        How many of the closest points are kept.

    Raises
    ------
    ContactError
        If the two shapes can never make a contact that this model understands.
    """

    name: str
    alpha: PlacedShape
    beta: PlacedShape
    mu_v: float
    mu_omega: float
    rows: int
    k: int

    def __post_init__(self) -> None:
        clouds = [isinstance(s.shape, PointCloud) for s in (self.alpha, self.beta)]
        if all(clouds):
            raise ContactError(
                "two clouds cannot touch: a point has no surface; give one of the bodies a shape",
                field=self.name,
            )
        if self.alpha.link == self.beta.link:
            raise ContactError("both shapes are fixed to the same link", field=self.name)
        if not any(clouds) and self.k != 1:
            raise ContactError(
                "two convex shapes have one closest pair; k must be 1",
                field=self.name,
                value=self.k,
            )

    @property
    def n_c(self) -> int:
        """Number of contacts that this pair makes at every step."""
        shapes = (self.alpha.shape, self.beta.shape)
        sizes = [len(shape.points) for shape in shapes if isinstance(shape, PointCloud)]
        return min([self.k, *sizes])


@dataclass(frozen=True, eq=False)
class ContactLayout:
    """What does not change from step to step about the contacts of a list of pairs.

    Parameters
    ----------
    names : tuple of str, length n_c
        Each contact's pair.
    link_alpha, link_beta : ndarray of int, shape (n_c,)
    mu_v, mu_omega : ndarray, shape (n_c,)
        [-] and [m].
    rows : ndarray of int, shape (n_c,)
    """

    names: tuple[str, ...]
    link_alpha: NDArray[np.int64]
    link_beta: NDArray[np.int64]
    mu_v: Array
    mu_omega: Array
    rows: NDArray[np.int64]


def contact_layout(pairs: Sequence[ContactPair]) -> ContactLayout:
    """The layout of the contacts of some pairs, in order."""
    each = [pair for pair in pairs for _ in range(pair.n_c)]
    return ContactLayout(
        names=tuple(pair.name for pair in each),
        link_alpha=np.array([pair.alpha.link for pair in each], dtype=np.int64),
        link_beta=np.array([pair.beta.link for pair in each], dtype=np.int64),
        mu_v=np.array([pair.mu_v for pair in each], dtype=np.float64),
        mu_omega=np.array([pair.mu_omega for pair in each], dtype=np.float64),
        rows=np.array([pair.rows for pair in each], dtype=np.int64),
    )
