"""Inputs of a step that are moved along one of its coordinates or parameters, exactly.

Along a coordinate e_j of the tangent space q moves on a rational curve: a turn by w has the
quaternion (eps w / 2, 1), whose angle 2 atan(eps |w| / 2) differs from that of q (+) eps e_j by a
term of eps^3. A central difference on it has the same limit as on q (+) eps e_j.
"""

import copy
from collections.abc import Sequence

from flint import fmpq

from quasistatic_ref.lab.vectors.exact.algebra import Vector, add, moved, scaled
from quasistatic_ref.lab.vectors.exact.mechanism import Mechanism
from quasistatic_ref.lab.vectors.exact.precision import Real, number, numbers, root
from quasistatic_ref.lab.vectors.exact.rotation import quaternion_product, rotation
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers.step import wrench_force
from quasistatic_ref.lab.vectors.whole.grid import on_grid, vector_on_grid, working
from quasistatic_ref.lab.vectors.whole.world import world


def curved(tree: Mechanism, q: Sequence[Real], way: Vector) -> Vector:
    """Configuration near q (+) way: the difference is of third order in the way.

    Parameters
    ----------
    tree : Mechanism
    q : sequence of number
        All of it, or its actuated part.
    way : vector
        Small numbers, one for each entry of delta_q of that part [m, rad].
    """
    after = numbers(q)
    for body in tree.bodies:
        if body.mimic is None and body.q.stop <= len(after):
            after[body.q] = _curved(body.kind, after[body.q], way[body.v])
    return after


def _curved(kind: str, q: Vector, way: Vector) -> Vector:
    match kind:
        case "floating":
            turn = [*scaled(way[3:], fmpq(1, 2)), fmpq(1)]
            return [*moved(rotation(q[3:]), q[:3], way[:3]), *quaternion_product(q[3:], turn)]
        case "planar":
            c, s = q[2:]
            unit = 1 / length_of(c, s)
            forward, sideways = (scaled([c, s], unit), scaled([-s, c], unit))
            t = add(scaled(forward, way[0]), scaled(sideways, way[1]))
            return [*add(q[:2], t), *_turned(q[2:], way[2])]
        case "continuous":
            return _turned(q, way[0])
        case _:
            return add(q, way)


def length_of(c: Real, s: Real) -> Real:
    """Length of (cos, sin), on the grid where it is not rational."""
    with working():
        return on_grid(root(c * c + s * s))


def _turned(unit: Vector, angle: Real) -> Vector:
    c, s = unit
    cosine, sine = 4 - angle * angle, 4 * angle
    return [c * cosine - s * sine, s * cosine + c * sine]


def with_q(tree: Mechanism, way: Vector, case: Json, by: fmpq) -> Json:
    """The case at q (+) by times way, but for terms of third order."""
    return {**case, "q": curved(tree, case["q"], scaled(way, by))}


def with_target(tree: Mechanism, way: Vector, case: Json, by: fmpq) -> Json:
    """The same of q_bar_a, with one number for each actuated coordinate."""
    return {**case, "q_bar_a": curved(tree, case["q_bar_a"], scaled(way, by))}


def with_force(way: Vector, case: Json, by: fmpq) -> Json:
    """The case with an additional generalised force, by times way [N, N m]."""
    more = scaled(way, by)
    return {**case, "tau": add(case["tau"], more) if "tau" in case else more}


def with_held_wrenches(case: Json) -> Json:
    """The case with its wrenches as the generalised force ``tau`` that they are at its q."""
    at = world(case)
    with working():
        tau = vector_on_grid(wrench_force(at.tree, at.at, case))
    return {**case, "wrenches": [], "tau": tau}


def with_friction(name: str, pair: int, case: Json, by: Real) -> Json:
    """The case with another coefficient of one of its pairs, ``mu_v`` or ``mu_omega``."""
    pairs = [dict(one) for one in case["pairs"]]
    pairs[pair][name] = number(pairs[pair][name]) + by
    return {**case, "pairs": pairs}


def with_stiffness(j: int, case: Json, by: Real) -> Json:
    """The case with another K_q[j][j]."""
    K = [numbers(row) for row in case["K_q"]]
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
