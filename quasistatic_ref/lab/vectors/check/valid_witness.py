"""Whether two points and a normal prove a signed distance, for answers that are not unique.

If alpha lies in its body and is its farthest point along n, beta in its own and the farthest
against n, then the gap along n is the signed distance, apart and in penetration. How far a point
is outside of a shape, and how far a shape reaches, are distances, too: those to a point, and to a
half-space.
"""

import numpy as np

from quasistatic_ref.lab.program.rotation import frame
from quasistatic_ref.lab.vectors.distances.solid_pair import witnesses
from quasistatic_ref.lab.vectors.exact.precision import rounded_results
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.tables import ORIGIN, at
from quasistatic_ref.step.data import Array

TILTED = 1e-9
"""Sine of an angle: that between a half-space's normal and a direction of float64 is 1e-16. To
fewer digits the tolerance of n is larger, and takes its place."""


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
        shape = case[name]
        pose = case[f"pose_{name}"]
        direction = sign * n
        ball = {"kind": "sphere", "radius": 0.0}
        if _phi(ball, at(*point), shape, pose) > tolerance:
            return f"{name} is outside its shape"
        if shape["kind"] == "halfspace":
            normal = frame(pose)[0] @ shape["normal"]
            sine = np.linalg.norm(np.cross(direction, normal)) / np.linalg.norm(normal)
            ends = sine <= max(TILTED, tolerance) and direction @ normal > 0
            short = -_phi(ball, at(*point), shape, pose) if ends else np.inf
        else:
            beyond = {"kind": "halfspace", "normal": list(-direction), "offset": -direction @ point}
            short = -_phi(beyond, ORIGIN, shape, pose)
        if short > tolerance:
            return f"{name} is not where its shape ends along n"
    return None


def _phi(alpha: Json, pose_alpha: Json, beta: Json, pose_beta: Json) -> float:
    case = {"alpha": alpha, "beta": beta, "pose_alpha": pose_alpha, "pose_beta": pose_beta}
    phi: float = rounded_results(lambda: witnesses(case)[0].phi)[0]
    return phi


def solid_cases(case: Json) -> list[Json]:
    """The case itself, or one for each point of its cloud."""
    for name in ("alpha", "beta"):
        if case[name]["kind"] == "cloud":
            R, t = frame(case[f"pose_{name}"])
            points = np.array(case[name]["points"]) @ R.T + t
            ball = {name: {"kind": "sphere", "radius": 0.0}}
            return [{**case, **ball, f"pose_{name}": at(*point.tolist())} for point in points]
    return [case]
