"""A simulator's contacts as the structures of scene.h."""

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.optional.fast.compiled.poses import Poses
from quasistatic_ref.optional.fast.compiled.solids import SolidPairs, solid
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.optional.fast.geometry import PosedGeometry
from quasistatic_ref.optional.fast.posed import Constants
from quasistatic_ref.optional.fast.tracker.tracker import ContactTracker
from quasistatic_ref.step.cones import cone_function, cone_matrix
from quasistatic_ref.step.data import Array, Indices


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
        Of all pairs, where compiled code measures each.
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
        layout = constant.row_layout
        n_c = len(layout.counts)
        m = int(layout.offsets[-1])
        n_a = len(constant.K_q)
        n_x = len(column_map.owner)
        n_v = column_map.n_v
        super().__init__("scene.h", "Scene")
        self.given = given = np.dtype(
            [
                *((name, np.int64, (n_c,)) for name in ("point", "tie")),
                ("phi", np.float64, (n_c,)),
                *((name, np.float64, (n_c, 3)) for name in ("n", "alpha", "beta", "d1", "d2")),
                ("J", np.float64, (n_c, 4, n_v)), ("tau", np.float64, (n_v,)),
                ("g", np.float64, (n_v,)),
            ]
        )  # fmt: skip
        self._bytes = np.zeros(given.itemsize, np.uint8)
        written = np.ndarray((), given, self._bytes)
        self.tracker = tracker
        self.lists_made = 0
        alpha, beta = geometry.moves[:, :, 0]
        self.put(
            {
                "clouds": 0, "n_c": n_c, "n_v": n_v, "n_a": n_a, "n_x": n_x,
                "links": len(poses.R), "t": poses.t, "column": poses.columns,
                "owner": column_map.owner, "moves_alpha": alpha, "moves_beta": beta,
                "mu_v": geometry.mu[:, 0], "mu_omega": geometry.mu[:, 2], "rows": layout.counts,
                **cone_terms(constant.cone), **{name: written[name] for name in given.names or ()},
                "A": np.zeros((m, n_v)), "b": np.zeros(m), "work": np.zeros(14 * n_x + 4 * n_v),
                "h": np.array([constant.h]), "weighs": weighs, "gravity": poses.gravity,
                "force": np.zeros(n_v), "K_q": constant.K_q, "delta_q_bar_a": np.zeros(n_a),
            },
        )  # fmt: skip
        if tracker is not None:
            self.pairs = SolidPairs(tracker.pairs, poses.R, poses.t, self._arrays)
            self.put({"solids": self.pairs.address})
            if tracker.lists:
                self._put_clouds(tracker)

    def taken(self) -> NDArray[np.void]:
        """What C has written of a step, of shape (): its arrays by their names."""
        # A copy of the bytes is read-only; copying field by field takes ten times as long.
        return np.ndarray((), self.given, self._bytes.tobytes())

    @property
    def listed(self) -> bool:
        """Whether there are short lists of all clouds."""
        return self.tracker is not None and (self.lists_made > 0 or not self.tracker.lists)

    def relist(self) -> None:
        """Take over the tracker's short lists, where it has made new ones."""
        tracker = self.tracker
        if tracker is None or not tracker.lists or tracker.lists_made == self.lists_made:
            return
        self.lists_made = tracker.lists_made
        clouds = tracker.clouds
        self.put(
            {
                "first": clouds.start, "index": clouds.index, "points": clouds.points,
                "bounds": clouds.offset.shape[1], "slope": clouds.slope, "offset": clouds.offset,
            },
        )  # fmt: skip

    def _put_clouds(self, tracker: ContactTracker) -> None:
        """What does not change of the pairs with a cloud, in their order."""
        clouds = tracker.clouds
        most = max(pair.n_c for pair in clouds.pairs)
        self.solids = [solid(side.shape) for side in clouds.solids]
        self.put(
            {
                "clouds": clouds.P, "pair": np.flatnonzero(tracker.has_cloud),
                "swaps": clouds.solid_is_beta.astype(np.int64),
                "solid": np.array([one.address for one in self.solids]),
                "nearest": np.zeros(most), "rank": np.zeros(most, np.int64),
            },
        )  # fmt: skip


def cone_terms(name: str) -> dict[str, Array | Indices]:
    """Coefficients of slip_1, slip_2 and spin in a cone's rows [-], and which terms exist; (R, 3).

    A term with coefficient zero differs from no term: it can change the sign of a zero.
    """
    of_nan = cone_function(name)(0.0, *np.where(np.eye(3) > 0, np.nan, 0.0))
    has = np.isnan(np.array([np.broadcast_to(row, 3) for row in of_nan]))
    return {"coefficient": cone_matrix(name)[:, 1:], "has": has.astype(np.int64)}
