"""Whether an input is one of its layer: what the families keep to, and moves may break.

A q that cannot be has no answer, and is not looked at here.
"""

import numpy as np

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.trees import nodes

SQUARE = 1e-9
"""How far a frame may be from a right-handed one of unit vectors [-]."""


def is_valid(case: Json) -> bool:
    """Whether an input of the right shape is valid for its layer."""
    positive = ("radius", "length", "h", "size", "half_axes", "compliance")
    for path, value in nodes(case):
        key = path[-1] if path else ""
        if key in positive and not np.all(np.array(value) > 0):
            return False
        if key in ("quaternion", "axis", "normal") and not np.any(value):
            return False
        if key in ("mu_v", "mu_omega", "mass") and value < 0:
            return False
        if key == "inertia" and not _positive(value):
            return False
    if not all(_frame(contact) for contact in case.get("contacts", [])):
        return False
    if "normals" in case and not _has_normals(case):
        return False
    return all(_positive(case[key]) for key in ("H", "K_q") if case.get(key))


def _positive(matrix: Json) -> bool:
    """Whether a matrix is symmetric and positive definite, by its eigenvalues at scale one."""
    M = np.array(matrix, dtype=np.float64)
    if not (np.array_equal(M, M.T) and np.all(np.diag(M) > 0)):
        return False
    scale = 1 / np.sqrt(np.diag(M))
    return bool(np.linalg.eigvalsh(scale[:, None] * M * scale).min() > 1e-6)


def _has_normals(case: Json) -> bool:
    """Whether each distance of a selection has a unit normal, and no group is empty."""
    if not all(case["phi"]) or [*map(len, case["phi"])] != [*map(len, case["normals"])]:
        return False
    lengths = [np.linalg.norm(n, axis=1) for n in case["normals"]]
    return bool(np.abs(np.concatenate([*lengths, [1.0]]) - 1).max() < SQUARE)


def _frame(contact: Json) -> bool:
    n, d1, d2 = (np.array(contact[key]) for key in ("n", "d1", "d2"))
    R = np.stack([d1, d2, n])
    return bool(
        np.abs(R @ R.T - np.eye(3)).max() < SQUARE and np.abs(np.cross(n, d1) - d2).max() < SQUARE
    )
