"""The closest points of all pairs: of clouds on simple solids by C, of all others by the core."""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.contact.all_pairs import AllPairs
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.normals import UNIQUE_NORMAL
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.optional.compiled.library import Structure, library
from quasistatic_ref.optional.fast.poses import Poses
from quasistatic_ref.shapes.placed_shape import HalfSpace, PointCloud
from quasistatic_ref.shapes.rounded import Rounded


def solid_size(pair: ContactPair) -> Array | None:
    """The four numbers that C takes of a solid under a cloud; None if C does not know it.

    Returns
    -------
    ndarray, shape (4,), or None
        Half extents of the core and the ball's radius [m]; or normal [-] and offset [m].
    """
    a, b = pair.alpha.shape, pair.beta.shape
    if not pair.has_cloud:
        return None
    solid = b if isinstance(a, PointCloud) else a
    if isinstance(solid, HalfSpace):
        return np.array([*solid.normal, solid.offset])
    return np.array([*solid.core[0], solid.core[1]]) if isinstance(solid, Rounded) else None


def cloud(pair: ContactPair, size: Array, poses: Poses, written: ClosestPoints) -> Structure:
    """The structure ``Cloud`` of fast.h for a pair with a cloud.

    Parameters
    ----------
    pair : ContactPair
    size : ndarray, shape (4,)
        Of its :func:`solid_size` [m; -].
    poses : Poses
    written : ClosestPoints
        Where its contacts go.
    """
    first = isinstance(pair.alpha.shape, PointCloud)
    side, other = (pair.alpha, pair.beta) if first else (pair.beta, pair.alpha)
    assert isinstance(side.shape, PointCloud)
    points = side.shape.points
    fields: dict[str, int | Array | Indices] = {
        "is_half_space": int(isinstance(other.shape, HalfSpace)),
        "cloud_is_alpha": int(first),
        "points": len(points),
        "count": pair.n_c,
        "size": size,
        "resolution": np.array([pair.resolution]),
        "solid_on_link": np.column_stack([other.R, other.t]),
        "cloud_on_link": np.column_stack([side.R, side.t]),
        "point": points.T,
        "distance": np.zeros(len(points)),
        "phi": written.phi,
        "n": written.n,
        "alpha": written.alpha,
        "beta": written.beta,
        "index": written.point,
        "R_solid": int(poses.R[other.link]),
        "t_solid": int(poses.t[other.link]),
        "R_cloud": int(poses.R[side.link]),
        "t_cloud": int(poses.t[side.link]),
    }
    return Structure("Cloud", fields)


class Closest:
    """Writes the contacts of all pairs, in order.

    Parameters
    ----------
    pairs : sequence of ContactPair
    poses : Poses
    written : ClosestPoints
        Where they go.
    """

    def __init__(self, pairs: Sequence[ContactPair], poses: Poses, written: ClosestPoints) -> None:
        self._poses = poses
        self._by_c: list[tuple[Structure, ContactPair, ClosestPoints]] = []
        self._written = written
        by_core: list[ContactPair] = []
        starts: list[int] = []
        end = 0
        for pair in pairs:
            start = end
            end += pair.n_c
            out = ClosestPoints._make(field[start:end] for field in written)
            size = solid_size(pair)
            if size is None:
                by_core.append(pair)
                starts.append(start)
            else:
                self._by_c.append((cloud(pair, size, poses, out), pair, out))
        self._by_core = AllPairs(by_core, starts)

    def write(self) -> None:
        """Write the contacts at the poses; ContactError as of ``closest_points``."""
        compiled = library().closest_of_cloud
        left: list[tuple[ContactPair, ClosestPoints]] = []
        for structure, pair, out in self._by_c:
            if compiled(structure.pointer):
                out.tie[:] = UNIQUE_NORMAL
            else:
                left.append((pair, out))
        if self._by_core.n_c:
            self._by_core.write(self._poses.kinematics(), self._written)
        for pair, out in left:
            AllPairs([pair]).write(self._poses.kinematics(), out)
