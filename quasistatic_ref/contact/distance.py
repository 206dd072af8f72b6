"""Closest points, signed distances and normals of the pairs, in the world frame.

A pair with a cloud, or with a sphere (a cloud of one point, a radius away), has a closed form
in :mod:`~quasistatic_ref.contact.cloud`. Any other pair of convex shapes is asked of coal, and
the answer is checked: a normal that does not agree with its witness points is an error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import coal
import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.cloud import closest, signed_distance
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.shapes import PlacedShape, PointCloud, Sphere
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import WITNESS


@dataclass(frozen=True, eq=False)
class ClosestPoints:
    """Candidate contacts, in the world frame.

    Parameters
    ----------
    phi : ndarray, shape (n_c,)
        Signed distance [m].
    alpha, beta : ndarray, shape (n_c, 3)
        Closest points on the two bodies [m]; beta - alpha = phi n.
    n : ndarray, shape (n_c, 3)
        Unit normal from alpha's body to beta's, also in penetration.
    point : ndarray of int, shape (n_c,)
        Index of the cloud's point; 0 where there is no cloud.
    """

    phi: Array
    alpha: Array
    beta: Array
    n: Array
    point: NDArray[np.int64]

    def swapped(self) -> ClosestPoints:
        """The same contacts with alpha's and beta's bodies exchanged."""
        return ClosestPoints(self.phi, self.beta, self.alpha, -self.n, self.point)


def closest_points(pairs: Sequence[ContactPair], kinematics: Kinematics) -> ClosestPoints:
    """The contacts of all pairs, in order, each pair's in ascending distance.

    Raises
    ------
    ContactError
        If a pair has no trustworthy normal.
    """
    found = [pair_closest_points(pair, kinematics) for pair in pairs]
    if not found:
        empty = np.zeros((0, 3))
        return ClosestPoints(np.zeros(0), empty, empty, empty, np.zeros(0, dtype=np.int64))
    return ClosestPoints(
        phi=np.concatenate([f.phi for f in found]),
        alpha=np.concatenate([f.alpha for f in found]),
        beta=np.concatenate([f.beta for f in found]),
        n=np.concatenate([f.n for f in found]),
        point=np.concatenate([f.point for f in found]),
    )


def pair_closest_points(pair: ContactPair, kinematics: Kinematics) -> ClosestPoints:
    """The contacts of one pair, by the road that suits its shapes."""
    a, b = pair.alpha, pair.beta
    if isinstance(b.shape, PointCloud):
        return _cloud_on_shape(a, b, b.shape.points, 0.0, pair.k, kinematics)
    if isinstance(a.shape, PointCloud):
        return _cloud_on_shape(b, a, a.shape.points, 0.0, pair.k, kinematics).swapped()
    centre = np.zeros((1, 3))
    if isinstance(b.shape, Sphere):
        return _cloud_on_shape(a, b, centre, b.shape.radius, 1, kinematics)
    if isinstance(a.shape, Sphere):
        return _cloud_on_shape(b, a, centre, a.shape.radius, 1, kinematics).swapped()
    return _by_coal(pair, kinematics)


def _cloud_on_shape(
    solid: PlacedShape,
    cloud: PlacedShape,
    points: Array,
    radius: float,
    k: int,
    kinematics: Kinematics,
) -> ClosestPoints:
    """The k points, each with a ball of some radius about it, that are closest to a solid."""
    R_s, t_s = _pose(solid, kinematics)
    R_c, t_c = _pose(cloud, kinematics)
    in_solid = _rotated(R_s.T @ R_c, points) + R_s.T @ (t_c - t_s)
    phi, normal = signed_distance(solid.shape, in_solid)
    index = closest(phi, k)
    n = _rotated(R_s, normal[index])
    centre = _rotated(R_c, points[index]) + t_c
    distance = phi[index]
    return ClosestPoints(
        phi=distance - radius,
        alpha=centre - distance[:, None] * n,
        beta=centre - radius * n,
        n=n,
        point=index,
    )


def _by_coal(pair: ContactPair, kinematics: Kinematics) -> ClosestPoints:
    shape_a, shape_b = pair.alpha.shape, pair.beta.shape
    if isinstance(shape_a, PointCloud) or isinstance(shape_b, PointCloud):
        raise ContactError("a cloud has no coal object", field=pair.name)
    R_a, t_a = _pose(pair.alpha, kinematics)
    R_b, t_b = _pose(pair.beta, kinematics)
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    request.enable_signed_distance = True
    phi = coal.distance(
        shape_a.coal,
        coal.Transform3s(R_a, t_a),
        shape_b.coal,
        coal.Transform3s(R_b, t_b),
        request,
        result,
    )
    alpha, beta = np.array(result.getNearestPoint1()), np.array(result.getNearestPoint2())
    n = np.array(result.normal)
    # `not <=` so that NaN is refused as well.
    consistent = np.abs(beta - alpha - phi * n).max() <= WITNESS
    if not (consistent and abs(n @ n - 1) <= WITNESS):
        raise ContactError(
            "no trustworthy contact normal at this pose; move the bodies slightly, or use a cloud",
            field=pair.name,
            value={"phi": phi, "n": n.tolist()},
        )
    one = np.zeros(1, dtype=np.int64)
    return ClosestPoints(np.array([phi]), alpha[None], beta[None], n[None], one)


def _pose(placed: PlacedShape, kinematics: Kinematics) -> tuple[Array, Array]:
    R, t = kinematics.R[placed.link], kinematics.t[placed.link]
    return R @ placed.R, R @ placed.t + t


def _rotated(R: Array, points: Array) -> Array:
    # Not `@`: BLAS may sum in another order for another number of points, and a point's
    # distance must not depend on its company.
    return points[:, :1] * R[:, 0] + points[:, 1:2] * R[:, 1] + points[:, 2:] * R[:, 2]
