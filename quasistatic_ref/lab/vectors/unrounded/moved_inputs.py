"""Inputs of a step that are moved along one of its coordinates or parameters, exactly.

Along a coordinate e_j of the tangent space q moves on a rational curve: a turn by w has the
quaternion (eps w / 2, 1), whose angle 2 atan(eps |w| / 2) differs from that of q (+) eps e_j by a
term of eps^3. A central difference on it has the same limit as on q (+) eps e_j.
"""

import copy
from collections.abc import Sequence
from typing import Any

import numpy as np
from flint import fmpq

from quasistatic_ref.lab.program.mechanism import slices
from quasistatic_ref.lab.program.rotation import quaternion_product, rotation
from quasistatic_ref.lab.vectors.exact.algebra import Vector, vector
from quasistatic_ref.lab.vectors.exact.precision import Real, number, root
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.unrounded.grid import on_grid, working
from quasistatic_ref.lab.vectors.unrounded.world import world

Array = Any
"""An array of rational numbers."""


def curved(mechanism: Json, q: Sequence[Real], way: Vector) -> Vector:
    """Configuration near q (+) way: the difference is of third order in the way.

    Parameters
    ----------
    mechanism : dict
    q : sequence of number
        All of it, or its actuated part.
    way : vector
        Small numbers, one for each entry of delta_q of that part [m, rad].
    """
    after: Array = np.array(q)
    kinds = {body["name"]: body["joint"] for body in mechanism["bodies"]}
    for name, (i, k) in slices(mechanism)[0].items():
        if i.stop <= len(after):
            after[i] = _curved(kinds[name], after[i], np.array(way[k]))
    return list(after)


def _curved(kind: str, q: Array, way: Array) -> Array:
    match kind:
        case "floating":
            turned = quaternion_product(q[3:], np.append(way[3:] / 2, 1))
            return np.append(q[:3] + rotation(q[3:]) @ way[:3], turned)
        case "planar":
            c, s = q[2:] / length_of(*q[2:])
            t = np.array([[c, -s], [s, c]]) @ way[:2]
            return np.append(q[:2] + t, _turned(q[2:], way[2]))
        case "continuous":
            return _turned(q, way[0])
        case _:
            return q + way


def length_of(c: Real, s: Real) -> Real:
    """Length of (cos, sin), on the grid where it is not rational."""
    with working():
        return on_grid(root(c * c + s * s))


def _turned(unit: Array, angle: Real) -> Array:
    (c, s), square = unit, angle * angle
    return np.array([[c, -s], [s, c]]) @ np.array([4 - square, 4 * angle])


def with_q(way: Vector, case: Json, by: fmpq) -> Json:
    """The case at q (+) by times way, but for terms of third order."""
    return {**case, "q": curved(case["mechanism"], case["q"], by * way)}


def with_target(way: Vector, case: Json, by: fmpq) -> Json:
    """The same of q_bar_a, with one number for each actuated coordinate."""
    return {**case, "q_bar_a": curved(case["mechanism"], case["q_bar_a"], by * way)}


def with_force(way: Vector, case: Json, by: fmpq) -> Json:
    """The case with an additional generalised force, by times way [N, N m]."""
    more = by * way
    return {**case, "tau": case["tau"] + more if "tau" in case else more}


def with_held_wrenches(case: Json) -> Json:
    """The case with its wrenches as the generalised force ``tau`` that they are at its q."""
    at = world({**case, "gravity": [0.0, 0.0, 0.0]})
    tau = on_grid(at.loads[1])
    return {**at.case, "gravity": list(vector(case["gravity"])), "wrenches": [], "tau": tau}


def with_friction(name: str, pair: int, case: Json, by: Real) -> Json:
    """The case with another coefficient of one of its pairs, ``mu_v`` or ``mu_omega``."""
    pairs = [dict(one) for one in case["pairs"]]
    pairs[pair][name] = number(pairs[pair][name]) + by
    return {**case, "pairs": pairs}


def with_stiffness(j: int, case: Json, by: Real) -> Json:
    """The case with another K_q[j][j]."""
    K = [vector(row) for row in case["K_q"]]
    K[j][j] += by
    return {**case, "K_q": K}


def with_time(case: Json, by: Real) -> Json:
    """The case with another h [s]."""
    return {**case, "h": number(case["h"]) + by}


def with_mass(body: int, case: Json, by: Real) -> Json:
    """The case with another mass [kg] of a body, its centre of mass and inertia kept."""
    bodies = copy.deepcopy(case["mechanism"]["bodies"])
    bodies[body]["mass"] = number(bodies[body]["mass"]) + by
    return {**case, "mechanism": {"bodies": bodies}}
