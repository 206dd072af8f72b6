"""A simulator's contacts as the structures of scene.h."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.poses import Poses
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.optional.fast.geometry import PosedGeometry
from quasistatic_ref.optional.fast.posed import Constants
from quasistatic_ref.optional.fast.tracker.tracker import ContactTracker, FollowedCloud
from quasistatic_ref.shapes import placed_shape as shapes
from quasistatic_ref.shapes.rounded import Rounded
from quasistatic_ref.step.cones import cone_function, cone_matrix
from quasistatic_ref.step.data import Array, Indices

ROUNDED_BOX, HALF_SPACE, CYLINDER = range(3)
"""Kinds of solids, as scene.h counts them."""

NUMBERS = ("pairs", "n_c", "n_v", "n_a", "n_x", "links", "mimics")
ARRAYS = (
    "R", "t", "column",
    "link_solid", "link_cloud", "on_solid", "on_cloud",
    "kind", "size", "sign",
    "first", "length", "index", "x", "y", "z", "bounds", "slope", "offset",
    "start", "count",
    "owner", "moves_alpha", "moves_beta", "mu_v", "mu_omega", "rows",
    "coefficient", "has",
    "world", "nearest", "rank", "point",
    "phi", "n", "alpha", "beta", "d1", "d2", "J", "A", "b", "work",
    "h", "weighs", "gravity", "force", "K_q", "delta_q_bar_a", "tau", "g",
)  # fmt: skip
"""The fields of ``Scene`` in scene.h, one for one."""


def known(shape: shapes.Shape) -> bool:
    """Whether compiled code knows the distance to a solid."""
    return isinstance(shape, Rounded | shapes.HalfSpace | shapes.Cylinder)


class Scene(Structure):
    """``Scene`` of scene.h.

    Parameters
    ----------
    poses : Poses
        Where pinocchio writes the poses of the links.
    geometry : PosedGeometry
    constant : Constants
        In a polyhedral cone.
    weighs : ndarray, shape (n_v,)
        1.0 for each coordinate that feels gravity, else 0.0 [-].
    tracker : ContactTracker or None
        Of all pairs, where each has a cloud and a solid that is :func:`known`.
    """

    def __init__(
        self,
        poses: Poses,
        geometry: PosedGeometry,
        constant: Constants,
        weighs: Array,
        tracker: ContactTracker | None,
    ) -> None:
        column_map = geometry.column_map
        layout = constant.layout
        n_c, m, n_a = len(layout.counts), int(layout.offsets[-1]), len(constant.K_q)
        n_x, n_v = len(column_map.owner), column_map.n_v
        super().__init__(NUMBERS, ARRAYS, library().scene_size)
        self.given = given = np.dtype(
            [
                ("point", np.int64, (n_c,)), ("phi", np.float64, (n_c,)),
                *((name, np.float64, (n_c, 3)) for name in ("n", "alpha", "beta", "d1", "d2")),
                ("J", np.float64, (n_c, 4, n_v)), ("tau", np.float64, (n_v,)),
                ("g", np.float64, (n_v,)),
            ]
        )  # fmt: skip
        self._bytes = np.zeros(given.itemsize, np.uint8)
        written = np.ndarray((), given, self._bytes)
        self.tracker, self.lists_made = tracker, 0
        alpha, beta = geometry.moves[:, :, 0]
        self.put(
            {
                "pairs": 0, "n_c": n_c, "n_v": n_v, "n_a": n_a, "n_x": n_x,
                "links": len(poses.R), "mimics": int(column_map.mimics),
                "R": poses.R, "t": poses.t, "column": poses.columns,
                "owner": column_map.owner,
                "moves_alpha": alpha, "moves_beta": beta,
                "mu_v": geometry.mu[:, 0], "mu_omega": geometry.mu[:, 2], "rows": layout.counts,
                **cone_terms(constant.cone), **{name: written[name] for name in given.names or ()},
                "A": np.zeros((m, n_v)), "b": np.zeros(m), "work": np.zeros(14 * n_x + 4 * n_v),
                "h": np.array([constant.h]), "weighs": weighs, "gravity": poses.gravity,
                "force": np.zeros(n_v), "K_q": constant.K_q, "delta_q_bar_a": np.zeros(n_a),
            },
        )  # fmt: skip
        if tracker is not None:
            self._put_pairs(tracker.clouds)

    def taken(self) -> NDArray[np.void]:
        """What C has written of a step, of shape (): its arrays by their names."""
        # A copy of the bytes is read-only; copying field by field takes ten times as long.
        return np.ndarray((), self.given, self._bytes.tobytes())

    @property
    def listed(self) -> bool:
        """Whether there are short lists of all pairs."""
        return self.lists_made > 0

    def relist(self) -> None:
        """Take over the tracker's short lists, where it has made new ones."""
        tracker = self.tracker
        if tracker is None or tracker.lists_made == self.lists_made:
            return
        self.lists_made = tracker.lists_made
        index, points, slopes, offsets = [], [], [], []
        for cloud in tracker.clouds:
            assert cloud.list is not None
            slope, offset = cloud.list.bounds
            index.append(cloud.list.index)
            points.append(cloud.points[cloud.list.index])
            slopes.append(slope)
            offsets.append(offset)
        x, y, z = np.concatenate(points).T
        length = np.array([len(i) for i in index])
        self.put(
            {
                "first": starts(length)[:-1], "length": length, "index": np.concatenate(index),
                "x": x, "y": y, "z": z,
                "bounds": starts(np.array([len(offset) for offset in offsets])),
                "slope": np.concatenate(slopes), "offset": np.concatenate(offsets),
            },
        )  # fmt: skip

    def _put_pairs(self, clouds: Sequence[FollowedCloud]) -> None:
        """What does not change of the pairs, in their order."""
        count = np.array([cloud.pair.n_c for cloud in clouds])
        kinds, sizes = zip(*(solid_numbers(cloud.solid.shape) for cloud in clouds), strict=True)
        solids, points = [cloud.solid for cloud in clouds], [cloud.cloud for cloud in clouds]
        self.put(
            {
                "pairs": len(clouds),
                "link_solid": links(solids), "link_cloud": links(points),
                "on_solid": on_links(solids), "on_cloud": on_links(points),
                "kind": np.array(kinds), "size": np.array(sizes),
                "sign": np.array([cloud.sign for cloud in clouds]),
                "start": starts(count)[:-1], "count": count,
                "world": np.zeros((len(clouds), 24)), "nearest": np.zeros(count.max()),
                "rank": np.zeros(count.max(), np.int64),
            },
        )  # fmt: skip


def links(placed: Sequence[shapes.PlacedShape]) -> Indices:
    """The links of some shapes, shape (P,)."""
    return np.array([shape.link for shape in placed], dtype=np.int64)


def on_links(placed: Sequence[shapes.PlacedShape]) -> Array:
    """Where the shapes are on their links: [R, t], shape (P, 3, 4); t [m]."""
    return np.array([np.column_stack([shape.R, shape.t]) for shape in placed])


def starts(lengths: Indices) -> Indices:
    """Where each of some parts begins, and where the last ends, shape (parts + 1,)."""
    return np.concatenate([np.zeros(1, np.int64), np.cumsum(lengths)])


def solid_numbers(shape: shapes.Shape) -> tuple[int, list[float]]:
    """The kind of a solid, and the four numbers [m] that scene.h wants of that kind."""
    match shape:
        case shapes.HalfSpace():
            return HALF_SPACE, [*shape.normal.tolist(), shape.offset]
        case shapes.Cylinder():
            return CYLINDER, [shape.radius, shape.half_length, 0.0, 0.0]
        case _:
            assert isinstance(shape, Rounded)
            half_extents, ball = shape.core
            return ROUNDED_BOX, [*half_extents.tolist(), ball]


def cone_terms(name: str) -> dict[str, Array | Indices]:
    """Coefficients of slip_1, slip_2 and spin in a cone's rows [-], and which terms exist; (R, 3).

    A term with coefficient zero differs from no term: it can change the sign of a zero.
    """
    of_nan = cone_function(name)(0.0, *np.where(np.eye(3) > 0, np.nan, 0.0))
    has = np.isnan(np.array([np.broadcast_to(row, 3) for row in of_nan]))
    return {"coefficient": cone_matrix(name)[:, 1:], "has": has.astype(np.int64)}
