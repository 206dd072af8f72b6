"""Whether an input is one of its layer: what the families keep to, and moves may break."""

import numpy as np

from quasistatic_ref.lab.vectors.converters import UNITS, places
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.trees import nodes

SQUARE = 1e-9
"""How far a frame may be from a right-handed one of unit vectors [-]."""


def is_valid(name: str, case: Json) -> bool:
    """Whether an input is valid for a layer.

    Parameters
    ----------
    name : str
        A layer.
    case : dict
        Its input, of the right shape.
    """
    positive = ("radius", "length", "h", "size", "half_axes")
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
    if "mechanism" in case and not (case["mechanism"]["bodies"] and _turned(case)):
        return False
    return all(_positive(case[key]) for key in ("H", "K_q") if case.get(key))


def _positive(matrix: Json) -> bool:
    """Whether a matrix is symmetric and positive definite, by its eigenvalues at scale one."""
    M = np.array(matrix, dtype=np.float64)
    if not (np.array_equal(M, M.T) and np.all(np.diag(M) > 0)):
        return False
    scale = 1 / np.sqrt(np.diag(M))
    return bool(np.linalg.eigvalsh(scale[:, None] * M * scale).min() > 1e-6)


def _frame(contact: Json) -> bool:
    n, d1, d2 = (np.array(contact[key]) for key in ("n", "d1", "d2"))
    R = np.stack([d1, d2, n])
    return bool(
        np.abs(R @ R.T - np.eye(3)).max() < SQUARE and np.abs(np.cross(n, d1) - d2).max() < SQUARE
    )


def _turned(case: Json) -> bool:
    """Whether no quaternion and no (cos, sin) in q or in a target is zero."""
    found = list(places(case["mechanism"]))
    if len(case["q"]) != max((q.stop for _, q, _ in found), default=0):
        return False
    for body, q, _ in found:
        if body["joint"] in UNITS:
            part = slice(q.start + UNITS[body["joint"]], q.stop)
            values = [case["q"][part], case.get("q_bar_a", [])[part]]
            if not all(np.any(value) for value in values if value):
                return False
    return bool(found)
