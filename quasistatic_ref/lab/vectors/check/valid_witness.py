"""Whether two points and a normal prove a signed distance, for answers that are not unique.

If alpha lies in its body and is its farthest point along n, beta in its own and the farthest
against n, then the gap along n is the signed distance, apart and in penetration. Shapes are the
tables of a case, about their own origin; everything is float64.
"""

import numpy as np
from scipy.spatial import ConvexHull

from quasistatic_ref.lab.program.rotation import rotation
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.step.data import Array


def witness_problem(
    case: Json, phi: float, alpha: Array, beta: Array, n: Array, tolerance: float
) -> str | None:
    """What is wrong with a witness; None if it proves phi to within the tolerance.

    Parameters
    ----------
    case : dict
        Input of the layer ``distance``, of two solids (a point of a cloud as a sphere of radius
        zero).
    phi : float
        Signed distance [m].
    alpha, beta, n : ndarray, shape (3,)
        World frame.
    tolerance : float
        [m], and [-] for n.
    """
    if abs(np.linalg.norm(n) - 1) > tolerance:
        return "n is not of length one"
    if np.abs(beta - alpha - phi * n).max() > tolerance:
        return "beta - alpha is not phi n"
    for name, point, sign in (("alpha", alpha, 1.0), ("beta", beta, -1.0)):
        R, t = _pose(case[f"pose_{name}"])
        local, direction = R.T @ (point - t), sign * (R.T @ n)
        if excess(case[name], local) > tolerance:
            return f"{name} is outside its shape"
        if farthest(case[name], direction) - direction @ local > tolerance:
            return f"{name} is not where its shape ends along n"
    return None


def farthest(shape: Json, direction: Array) -> float:
    """How far a shape reaches along a direction of length one [m].

    Infinite for a half-space, unless the direction is its normal.
    """
    match shape["kind"]:
        case "sphere":
            return float(shape["radius"])
        case "box":
            return float(np.abs(direction) @ np.array(shape["size"]) / 2)
        case "capsule":
            return float(abs(direction[2]) * shape["length"] / 2 + shape["radius"])
        case "cylinder":
            across = np.hypot(direction[0], direction[1])
            return float(abs(direction[2]) * shape["length"] / 2 + shape["radius"] * across)
        case "cone":
            across, half = np.hypot(direction[0], direction[1]), shape["length"] / 2
            rim = shape["radius"] * across - half * direction[2]
            return float(max(half * direction[2], rim))
        case "ellipsoid":
            return float(np.linalg.norm(direction * np.array(shape["half_axes"])))
        case "halfspace":
            normal = np.array(shape["normal"])
            length = np.linalg.norm(normal)
            # The sine of the angle, which the direction of a float64 answer leaves at 1e-16.
            tilted = np.linalg.norm(np.cross(direction, normal / length)) > 1e-9
            return float("inf") if tilted or direction @ normal < 0 else shape["offset"] / length
        case _:
            return float((np.array(shape["vertices"]) @ direction).max())


def excess(shape: Json, point: Array) -> float:
    """How far a point is outside a shape [m], or a lower bound of that; negative within."""
    match shape["kind"]:
        case "sphere":
            return float(np.linalg.norm(point)) - float(shape["radius"])
        case "box":
            return float((np.abs(point) - np.array(shape["size"]) / 2).max())
        case "capsule":
            half = shape["length"] / 2
            axis = np.array([0.0, 0.0, np.clip(point[2], -half, half)])
            return float(np.linalg.norm(point - axis)) - float(shape["radius"])
        case "cylinder":
            across = np.hypot(point[0], point[1])
            return float(max(across - shape["radius"], abs(point[2]) - shape["length"] / 2))
        case "cone":
            across, half = np.hypot(point[0], point[1]), shape["length"] / 2
            slant = np.hypot(shape["radius"], 2 * half)
            side = (2 * half * across + shape["radius"] * (point[2] - half)) / slant
            return float(max(side, -half - point[2]))
        case "ellipsoid":
            a = np.array(shape["half_axes"])
            return float((np.linalg.norm(point / a) - 1) * a.min())
        case "halfspace":
            normal = np.array(shape["normal"])
            return float((point @ normal - shape["offset"]) / np.linalg.norm(normal))
        case _:
            facets = ConvexHull(np.array(shape["vertices"])).equations
            return float((facets[:, :3] @ point + facets[:, 3]).max())


def solid_cases(case: Json) -> list[Json]:
    """The case itself, or one for each point of its cloud."""
    for name in ("alpha", "beta"):
        if case[name]["kind"] == "cloud":
            R, t = _pose(case[f"pose_{name}"])
            points = np.array(case[name]["points"]) @ R.T + t
            unturned = [0.0, 0.0, 0.0, 1.0]
            return [
                {
                    **case,
                    name: {"kind": "sphere", "radius": 0.0},
                    f"pose_{name}": {"xyz": point.tolist(), "quaternion": unturned},
                }
                for point in points
            ]
    return [case]


def _pose(pose: Json) -> tuple[Array, Array]:
    return rotation(pose["quaternion"]), np.array(pose["xyz"], dtype=np.float64)
