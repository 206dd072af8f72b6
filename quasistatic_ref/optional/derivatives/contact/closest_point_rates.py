r"""How closest points, distance and normal of two bodies change as the bodies move: (R29).

The bodies' points at alpha and beta move by :math:`v_\alpha, v_\beta` and the bodies turn by
:math:`\omega_\alpha, \omega_\beta`. On its body a closest point moves by p, and its outward normal
turns by r; both are related by the body's
:class:`~quasistatic_ref.optional.derivatives.contact.features.Feature`. With
:math:`r_\alpha = dn - \omega_\alpha\times n` and :math:`r_\beta = -(dn - \omega_\beta\times n)`,
the condition :math:`\beta - \alpha = \phi n` gives

.. math:: (\phi + D_\alpha + D_\beta)\,dn + F_\alpha z_\alpha - F_\beta z_\beta
   = v_\beta - v_\alpha + D_\alpha(\omega_\alpha\times n) + D_\beta(\omega_\beta\times n) , \qquad
   F_\alpha^T dn = F_\alpha^T(\omega_\alpha\times n),\;
   F_\beta^T dn = F_\beta^T(\omega_\beta\times n)

(of a rim, plus :math:`z_\alpha` or minus :math:`z_\beta` times its curvature) across n, and along n
:math:`d\phi = n\cdot(v_\beta - v_\alpha)`. The matrix is singular where the closest points are not
unique, and at a distance of zero where neither surface has a normal. Points that slide along a
common straight line do no harm if the bodies cannot turn out of it: the equations are then
consistent, and no row depends on where along the line the points are.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.derivatives.contact.features import Feature
from quasistatic_ref.optional.derivatives.model.tangent import cross_matrix
from quasistatic_ref.optional.derivatives.tolerances import CONSISTENT, SPLIT, UNIQUE


class Rates(NamedTuple):
    """Derivatives by n_v coordinates of the closest points of N pairs.

    Parameters
    ----------
    phi : ndarray, shape (N, n_v)
    alpha, beta, n : ndarray, shape (N, 3, n_v)
    unique : ndarray of bool, shape (N,)
        Whether there are such derivatives; where there are none, the others mean nothing.
    blurred : ndarray of bool, shape (N,)
        Whether the points or normals themselves have lost half of their digits.
    level_rim : ndarray of bool, shape (N,)
        Whether a pair is on a rim of which no point is the nearest.
    slides : ndarray of bool, shape (N,)
        Whether its points may be anywhere along a line, where an edge ends among others, and it
        does not matter where.
    """

    phi: Array
    alpha: Array
    beta: Array
    n: Array
    unique: Mask
    blurred: Mask
    level_rim: Mask
    slides: Mask


def closest_point_rates(
    phi: Array, n: Array, features: Sequence[Feature], v: Array, omega: Array, size: Array
) -> Rates:
    """The derivatives of all pairs at once.

    Parameters
    ----------
    phi : ndarray, shape (N,)
    n : ndarray, shape (N, 3)
    features : sequence of Feature, length 2 N
        In the world frame, those of all alpha's bodies first, then beta's.
    v : ndarray, shape (2, N, 3, n_v)
        Velocity of the point that is the closest one now, on its body or with a corner [m].
    omega : ndarray, shape (2, N, 3, n_v)
        Angular velocity of the body [rad].
    size : ndarray, shape (N,)
        About how large the bodies are [m]: what a singular matrix is measured by.
    """
    N = len(phi)
    frames = np.linalg.svd(n[:, None])[2][:, 1:]  # two unit vectors across each n
    across = frames.transpose(0, 2, 1)
    turn = -cross_matrix(n) @ omega  # omega x n
    bend = np.array([f.bend for f in features]).reshape(2, N, 3, 3)
    free = np.zeros((2, N, 2, 3))  # the free directions, or that of a rim, filled up by zeros
    for columns, f in zip(free.reshape(-1, 2, 3), features, strict=True):
        columns[: len(f.free)] = f.free
        columns[: len(f.arc)] = f.arc
    curvature = np.array([f.curvature for f in features]).reshape(2, N)
    apart = v[1] - v[0]

    # Lengths are in units of s. Along a direction that a feature does not have, z is zero.
    s = size[:, None, None]
    bends = frames @ (bend.sum(axis=0) / s) @ across + phi[:, None, None] / s * np.eye(2)
    along = free @ across
    held = np.eye(2) * ~np.any(free, axis=3)[..., None]
    # F'r of a rim is its curvature times z, and r has the sign of its side.
    held[:, :, 0, 0] -= np.array([[1.0], [-1.0]]) * curvature * size
    matrix = np.block([
        [bends, along[0].transpose(0, 2, 1), -along[1].transpose(0, 2, 1)],
        [along[0], held[0], 0 * held[0]],
        [along[1], 0 * held[1], held[1]],
    ])  # fmt: skip
    bent = (bend @ turn).sum(axis=0)
    right = np.concatenate([frames @ (apart + bent) / s, *(free @ turn)], axis=1)

    least = np.linalg.svd(matrix, compute_uv=False)[:, -1]
    good = least > UNIQUE
    singular = np.flatnonzero(~good).tolist()
    turns = omega[1] - omega[0]
    sliding = [_sliding(matrix[j], right[j], free[0, j], turns[j]) for j in singular]
    matrix[singular] = np.eye(6)
    solved = np.linalg.solve(matrix, right)
    for j, solution in zip(singular, sliding, strict=True):
        if solution is not None:
            solved[j] = solution
            good[j] = True

    dn = across @ solved[:, :2]
    z = np.stack([solved[:, 2:4], solved[:, 4:]])
    outward = np.array([1.0, -1.0])[:, None, None, None]  # n is outward from alpha's bodies
    bent = outward * (bend @ (dn - turn))
    d_alpha, d_beta = v + bent + free.transpose(0, 1, 3, 2) @ z * s
    d_phi = np.einsum("ja,jak->jk", n, apart)
    no = np.zeros(N, dtype=bool)  # of rims and lines a single pair knows nothing
    return Rates(d_phi, d_alpha, d_beta, dn, good, ~good & (least > SPLIT), no, no)


def _sliding(matrix: Array, right: Array, free: Array, turns: Array) -> Array | None:
    """A solution of singular equations, (6, n_v), where it does not matter which; else None."""
    U, s, V = np.linalg.svd(matrix)
    rank = int(np.count_nonzero(s > UNIQUE))
    slides = V[rank:]
    if np.abs(slides[:, :2]).max() > CONSISTENT:
        return None  # the normal itself is not determined
    # If the bodies turn about the line alone, way . (turns x n) = 0: the equations are consistent.
    for way in slides[:, 2:4] @ free:
        if np.abs(np.cross(turns, way[:, None], axis=0)).max(initial=0.0) > CONSISTENT:
            return None
    return np.asarray(V[:rank].T @ ((U[:, :rank].T @ right) / s[:rank, None]))
