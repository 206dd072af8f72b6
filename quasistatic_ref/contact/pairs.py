"""Which shapes may touch, and their friction: all that a user says about contacts is kept here."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import count
from typing import Final

import numpy as np

from quasistatic_ref.contact.outlines import grain
from quasistatic_ref.errors import ContactError
from quasistatic_ref.numbers.arrays import Array, Indices, checked_array
from quasistatic_ref.quoting import clipped
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import HalfSpace, PlacedShape, PointCloud
from quasistatic_ref.text.plain import Plain

RANKED: Final = 1e-9
"""Fraction of the size of a pair's smaller shape to whose nearest multiple distances are rounded
before contacts rank by them [-].

Distances of what lies still change by some 1e-17 m from step to step, by 1e-16 of places; a contact
that is left out for another of the same rank is at most that much nearer."""


@dataclass(frozen=True, eq=False, repr=False)
class ContactPair(Plain):
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
        How many of the closest points are kept; all candidates if there are fewer.
    hull : bool
        Whether a mesh that is not convex may be taken for its hull.

    Raises
    ------
    ContactError
        If the two shapes can never make a contact that this model understands, or k is no
        whole number from 1 on.

    Examples
    --------
    >>> ball = qr.Body.of_shape("ball", qr.Sphere(0.05), mass=0.3, xyz=(0, 0, 0.05))
    >>> system = qr.System([ball])
    >>> floor = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
    >>> qr.ContactPair("f", floor, system.shapes[0], mu_v=0.5, mu_omega=0.01).n_c
    1
    """

    name: str
    alpha: PlacedShape
    beta: PlacedShape
    mu_v: float
    mu_omega: float
    rows: int = 6
    k: int = 1
    hull: bool = False

    def __repr__(self) -> str:
        friction = f"mu_v = {self.mu_v:g}, mu_omega = {self.mu_omega:g} m"
        return f"<ContactPair {clipped(self.name)}: {friction}, {self.rows} rows, k = {self.k}>"

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise ContactError("must be a text", field="name", value=self.name)
        for key in ("alpha", "beta"):
            if not isinstance(side := getattr(self, key), PlacedShape):
                problem = (
                    "must be a PlacedShape: for each shape of a body a pair with one of "
                    "System.shapes, for the world's PlacedShape.in_world(name, shape)"
                )
                field = f"{self.name}.{key}"
                raise ContactError(problem, field=field, value=type(side).__name__)
        for key in ("mu_v", "mu_omega"):
            friction = checked_array(getattr(self, key), f"{self.name}.{key}", (), ContactError)
            if friction < 0:
                problem = "must be at least 0"
                raise ContactError(problem, field=f"{self.name}.{key}", value=float(friction))
        if self.rows not in (4, 6):
            raise ContactError("must be 4 or 6", field=f"{self.name}.rows", value=self.rows)
        if isinstance(self.k, bool) or not isinstance(self.k, int | np.integer) or self.k < 1:
            problem = "must be a whole number, 1 or more"
            raise ContactError(problem, field=f"{self.name}.k", value=self.k)
        clouds = [isinstance(s.shape, PointCloud) for s in (self.alpha, self.beta)]
        if all(clouds):
            problem = (
                "two clouds cannot touch: a point has no surface; give one of the bodies a shape"
            )
            raise ContactError(problem, field=self.name)
        if self.alpha.link == self.beta.link:
            raise ContactError(
                "both shapes are fixed to the same link; leave the pair out", field=self.name
            )
        if all(isinstance(s.shape, HalfSpace) for s in (self.alpha, self.beta)):
            raise ContactError("two half-spaces always meet; bound one of them", field=self.name)
        for side in (self.alpha, self.beta):
            if isinstance(side.shape, ConvexMesh) and not (side.shape.is_convex or self.hull):
                raise ContactError(
                    f"the mesh of {side.name} is not convex: its hull holds "
                    f"{100 * side.shape.excess:.2g} % more; say hull = true to use the hull, "
                    "give the body a cloud, or write the mesh as several convex ones",
                    field=self.name,
                )

    @cached_property
    def poses(self) -> Array:
        """Poses [R, t] of alpha's and beta's shapes on their links, shape (2, 3, 4); t in [m]."""
        return np.array([np.column_stack([side.R, side.t]) for side in (self.alpha, self.beta)])

    @cached_property
    def has_cloud(self) -> bool:
        """Whether one side is a cloud."""
        return isinstance(self.alpha.shape, PointCloud) or isinstance(self.beta.shape, PointCloud)

    @cached_property
    def size(self) -> float:
        """Size of the smaller shape [m], single points excepted; 0 if neither shape has one."""
        extents = [side.shape.extent for side in (self.alpha, self.beta)]
        return min((x for x in extents if 0 < x < np.inf), default=0.0)

    @cached_property
    def resolution(self) -> float:
        """Length [m] to whose multiples distances are rounded before they are ranked."""
        return RANKED * self.size

    @cached_property
    def grain(self) -> float:
        """How far corners of one face may be off its plane, or parted [m]; 0 without a mesh."""
        return grain(self.alpha.shape, self.beta.shape)

    @cached_property
    def corners(self) -> int:
        """Number of corners of both shapes; the closest pair has the next number."""
        return self.alpha.shape.corner_count + self.beta.shape.corner_count

    @cached_property
    def candidates(self) -> int:
        """Largest number of points that its contacts are chosen from."""
        for shape in (self.alpha.shape, self.beta.shape):
            if isinstance(shape, PointCloud):
                return len(shape.points)
        pieces = min(self.alpha.shape.edge_count, self.beta.shape.edge_count)
        return self.corners + 2 * pieces + 1  # two convex curves cross twice for each piece

    @cached_property
    def n_c(self) -> int:
        """Number of contacts that this pair makes at every step."""
        return min(self.k, self.candidates)


@dataclass(frozen=True, eq=False)
class ContactLayout(Plain):
    """The constant fields of a step's contacts: names, friction and rows of each.

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
    link_alpha: Indices
    link_beta: Indices
    mu_v: Array
    mu_omega: Array
    rows: Indices

    def __post_init__(self) -> None:
        for array in (self.mu_v, self.mu_omega, self.rows):
            array.setflags(write=False)  # one array for all steps

    def contact_names(self, point: Indices) -> tuple[str, ...]:
        """A name for each contact: its pair, and its point's number, of shape (n_c,)."""
        return _numbered(self.names, point.tobytes())

    @property
    def slots(self) -> tuple[str, ...]:
        """A name for the place of each contact: its pair, and its number within that from 0."""
        numbers: dict[str, Iterator[int]] = defaultdict(count)
        return tuple(f"{name}/{next(numbers[name])}" for name in self.names)


@lru_cache(maxsize=8)  # points mostly stay from step to step
def _numbered(names: tuple[str, ...], point: bytes) -> tuple[str, ...]:
    """Names with a number each, from the bytes of these."""
    return tuple(map("{}/{}".format, names, np.frombuffer(point, np.int64).tolist()))


def checked_pairs(pairs: object) -> tuple[ContactPair, ...]:
    """Pairs as a tuple; ContactError of anything else."""
    every = tuple(pairs) if isinstance(pairs, Iterable) else (pairs,)
    for pair in every:
        if not isinstance(pair, ContactPair):
            problem = "must be a sequence of ContactPair"
            raise ContactError(problem, field="pairs", value=type(pair).__name__)
    return every


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
