"""Layer 2, and the candidates of a pair of shapes: which points become contacts, in which frame."""

import numpy as np

from .distance import closest_points
from .rotation import AXES, unit

REPEATED = 1e-9
"""[m], and [-] of normals: candidates that differ by less are one."""


def selection(case):
    """Layer 2: a stable sort is a tie broken by index; of two solids those about one normal."""
    found = []
    for g, phi in enumerate(case["phi"]):
        order = np.argsort(phi, kind="stable")
        if "normals" in case:
            n = np.array(case["normals"][g])
            order = order[n[order] @ n[-1] >= np.cos(0.25)]
        filling = range(len(phi), 2 * len(phi) - len(order))
        indices = [*order.tolist(), *filling][: case["k"]]
        found.append(indices)
    return {"indices": found}


def corners(shape):
    """The corners of a box, the sign of x changing first; other solids have none here."""
    if shape["kind"] != "box":
        return []
    signs = 2 * ((np.arange(8)[:, None] >> np.arange(3)) & 1) - 1
    return signs * np.array(shape["size"]) / 2


def candidates(alpha, pose_alpha, beta, pose_beta, k):
    """phi, alpha, beta, n of all candidates, and which come after all others."""
    clouds = "cloud" in (alpha["kind"], beta["kind"])
    parts = []
    if k > 1 and not clouds:
        for shape, swap in ((alpha, True), (beta, False)):
            points = {"kind": "cloud", "points": corners(shape)}
            if len(points["points"]):
                pair = (points, pose_alpha, beta, pose_beta)
                parts.append(pair if swap else (alpha, pose_alpha, points, pose_beta))
    parts.append((alpha, pose_alpha, beta, pose_beta))
    found = [closest_points(*part) for part in parts]
    phi = np.concatenate([np.atleast_1d(one[0]) for one in found])
    a, b, n = (np.concatenate([np.reshape(one[i], (-1, 3)) for one in found]) for i in (1, 2, 3))
    late = np.zeros(len(phi), dtype=bool)
    if k > 1 and not clouds:
        late, _ = lateness(phi, a, n, k, REPEATED)
    return phi, a, b, n, late


def lateness(phi, alpha, n, k, repeated):
    """Which candidates of two solids come after all others, and whether k corners will do.

    Late are those that repeat an earlier one, and the closest pair, which is the last, where k
    corners are as near. What differs by no more than `repeated`, of their kind of number, is one.
    """
    every = np.column_stack([phi, alpha, n])
    same = np.all(np.abs(every[:, None] - every) <= repeated, axis=2)
    late = np.tril(same, -1).any(axis=1)
    enough = np.sum(~late[:-1] & (phi[:-1] <= phi[-1] + repeated)) >= k
    late[-1] |= enough
    return late, enough


def chosen(phi, late, k):
    """The k nearest of the candidates, in the order of their index."""
    order = np.lexsort((np.arange(len(phi)), phi, late))
    return np.sort(order[:k])


def tangents(n):
    """d1, d2 of a normal."""
    i = int(np.argmin(np.abs(n)))
    d1 = unit(AXES[i] - n[i] * n)
    return d1, np.cross(n, d1)
