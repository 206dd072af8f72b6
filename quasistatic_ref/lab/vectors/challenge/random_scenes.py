"""Random scenes of the layer `step`: mechanisms of every kind that nearly touch something.

A shape of any kind on a body, and another in the world or on another body, are put where the gap
between them is small; centres of mass are not at origins, wrenches act on any body, gravity is
along any direction, and targets are near or far. Of bricks and clouds several points nearly touch.
"""

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref.lab.made_steps.at_random import Rng, spread_matrix
from quasistatic_ref.lab.program.distance import closest_points
from quasistatic_ref.lab.program.mechanism import kinematics, slices
from quasistatic_ref.lab.program.rotation import frame
from quasistatic_ref.lab.program.step import pose_in_world
from quasistatic_ref.lab.vectors.challenge.random_mechanisms import (
    BASES,
    KINDS,
    few_digits,
    mass,
    random_follower,
    random_pose,
    random_q,
    random_quaternion,
    random_tree,
)
from quasistatic_ref.lab.vectors.tables import GRAVITY, UPRIGHT, free_body, link, on, scene
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.numbers.arrays import Array

EASY, PLAIN, HARD = 0, 1, 2
"""How hard cases are: a ball on a plane; as the vectors have them; more bodies, or corners."""
CONES = ("pyramid", "pyramid", "product", "facets-4", "facets-6", "facets-8", "frictionless")
ASIDE = 1e-11
"""A hundredth of the tolerance of what is on an edge [m]."""
GAPS = (0.0005, 0.0, -0.0005, 0.01)
"""[m]"""
FAR_GAPS = (*GAPS, -0.0005, 0.3, -0.02)
SHAPES: dict[str, Json] = {
    "sphere": {"radius": 0.06},
    "box": {"size": [0.09, 0.15, 0.12]},
    "halfspace": {"normal": [0.1, 0.2, 0.97], "offset": 0.1},
    "capsule": {"radius": 0.03, "length": 0.15},
    "convex": {
        "vertices": [
            [0.09, 0.03, 0.0],
            [-0.06, 0.09, 0.03],
            [-0.03, -0.09, 0.0],
            [0.02, 0.0, 0.12],
            [0.0, 0.03, -0.06],
            [0.06, -0.06, 0.05],
        ]
    },
    "cloud": {
        "points": [[0.0, 0.0, 0.0], [0.05, 0.0, 0.05], [-0.05, 0.0, 0.04], [0.0, 0.08, 0.01]]
    },
    "cylinder": {"radius": 0.05, "length": 0.12},
    "cone": {"radius": 0.06, "length": 0.15},
    "ellipsoid": {"half_axes": [0.03, 0.06, 0.09]},
}
"""One shape of each kind, of the size of things that a robot holds [m]."""
WITH_CORNERS = ("sphere", "box", "halfspace")
"""Several points of a box are kept where it meets one of these."""


def random_scene(rng: Rng, level: int) -> Json:
    """A random scene as the input of a case; a higher level has more in it."""
    kind = int(rng.integers(4))
    if level != EASY and kind == 0:
        return (_cloud if rng.integers(5) < 2 else _bricks)(rng)
    tree = _bodies(rng, level, kind)
    bodies = {"bodies": tree}
    q = random_q(rng, bodies)
    places, n_a, _ = slices(bodies)
    n_q_a = max((i.stop for i, k in places.values() if k.stop <= n_a), default=0)
    case = scene(
        tree,
        {},
        q,
        pairs=[],
        K_q=np.round(spread_matrix(rng, n_a, 200.0)).tolist(),
        q_bar_a=_target(rng, bodies, np.array(q[:n_q_a])),
        cone=str(rng.choice(CONES)),
        gravity=GRAVITY if rng.integers(2) else few_digits(rng.uniform(-10, 10, 3), 1),
        h=float(rng.choice([0.01, 0.01, 0.02, 0.1])),
    )
    pushed = [body["name"] for body in tree if rng.integers(3) == 0]
    if pushed:
        case["wrenches"] = [
            {
                "body": name,
                "force": few_digits(rng.uniform(-3, 3, 3), 2),
                "torque": few_digits(rng.uniform(-0.1, 0.1, 3), 3),
            }
            for name in pushed
        ]
    _touch(rng, case, tree[-1]["name"], level)
    return case


def _bodies(rng: Rng, level: int, kind: int) -> list[Json]:
    """The bodies of a mechanism; the last one moves."""
    if level == EASY:
        joint = str(rng.choice([*BASES, *KINDS[:3]]))
        return [link("body0", None, joint, actuated=bool(rng.integers(2))) | mass(rng)]
    if kind == 1:
        tree = [{**free_body("body0"), **mass(rng)}]
    elif kind == 2:
        stand = link("stand", None, "fixed")
        tree = [stand, *(body | mass(rng) for body in random_follower(rng, "stand"))]
    else:
        base = str(rng.choice(["fixed", *BASES, *KINDS[:3]]))
        tree = random_tree(rng, int(rng.integers(2, 3 + level)), base)["bodies"]
        tree[-1]["joint"] = "revolute" if tree[-1]["joint"] == "fixed" else tree[-1]["joint"]
    if level == HARD and rng.integers(2):
        tree.append({**free_body("other"), **mass(rng)})
    return tree


def _target(rng: Rng, bodies: Json, q_a: Array) -> list[float]:
    """A target next to q_a, or far from it: across pi, and by quaternions of either sign."""
    if rng.integers(2):
        return few_digits(q_a + rng.uniform(-0.02, 0.02, len(q_a)))
    far = np.array(random_q(rng, bodies)[: len(q_a)]) * rng.choice([-1, 1], len(q_a))
    joints = {body["name"]: body["joint"] for body in bodies["bodies"]}
    for name, (place, _) in slices(bodies)[0].items():
        if joints[name] in ("continuous", "planar") and place.stop <= len(q_a):
            cosine_sine = slice(place.stop - 2, place.stop)
            far[cosine_sine] = np.abs(far[cosine_sine]) * [-1.0, -0.125]
    return few_digits(far)


def _add_pair(rng: Rng, case: Json, alpha: str, beta: str, k: int) -> None:
    """Make a contact pair of two shapes of a scene, in either order."""
    friction = few_digits([rng.uniform(0.1, 1), rng.uniform(0.001, 0.02)], 3)
    friction = [0.0, 0.0] if rng.integers(10) == 0 else friction
    sides = (alpha, beta) if rng.integers(3) else (beta, alpha)
    pair = {"name": f"{alpha}_{len(case['pairs'])}", "alpha": sides[0], "beta": sides[1], "k": k}
    pair |= {"mu_v": friction[0], "mu_omega": friction[1], "rows": int(rng.choice([4, 6, 6]))}
    case["pairs"].append(pair)


def _shape(rng: Rng, kind: str) -> Json:
    """A shape of other lengths; one in four is a thousand times thinner than it is long."""
    factor = float(rng.choice([0.5, 1.0, 1.5]))
    scaled = {key: np.multiply(factor, value) for key, value in SHAPES[kind].items()}
    if kind == "halfspace":
        normal = np.array(few_digits(rng.uniform([-1.0, -1.0, -0.5], [1.0, 1.0, 1.5]), 2))
        if rng.integers(4) == 0:  # d1 is the first of equal axes
            normal = rng.permutation([normal[0], normal[0], 2 * abs(normal[0]) + 0.25])
        scaled["normal"] = normal
    if kind == "box" and rng.integers(8) == 0:
        scaled["size"][int(rng.integers(3))] /= 1000
    if kind == "cloud" and rng.integers(2):
        scaled["points"] = np.round(rng.uniform(-0.1, 0.1, (12, 3)), 3)
    return {"kind": kind, **{key: value.tolist() for key, value in scaled.items()}}


def _touch(rng: Rng, case: Json, body: str, level: int) -> None:
    """Put a shape on a body, and others where they nearly touch it."""
    kinds = ["sphere"] if level == EASY else [kind for kind in SHAPES if kind != "halfspace"]
    kind = str(rng.choice(kinds))
    shape = on(body, _shape(rng, kind), few_digits(rng.uniform(0, 0.1, 1))[0])
    if level != EASY:
        shape["pose"]["quaternion"] = random_quaternion(rng)
    case["shapes"]["body"] = shape
    solids = ["halfspace"] if level == EASY else [other for other in SHAPES if other != "cloud"]
    bodies = [one["name"] for one in case["mechanism"]["bodies"] if one["name"] != body]
    gap = 0.0
    for name in ("floor", "lid")[: 1 + (level == HARD and rng.integers(3) == 0)]:
        other = "halfspace" if rng.integers(3) == 0 else str(rng.choice(solids))
        under = str(rng.choice(bodies)) if bodies and rng.integers(3) == 0 else None
        gap = float(rng.choice(GAPS if level == EASY else FAR_GAPS))
        entry = {"body": under, "pose": random_pose(rng), "shape": _shape(rng, other)}
        _put_against(case, name, entry, gap, 0.6 * _direction(rng))
        corners = "box" in (kind, other) and {kind, other} <= {*WITH_CORNERS}
        k = int(rng.integers(2, 6)) if kind == "cloud" or corners else 1
        _add_pair(rng, case, name, "body", k)
    if level == HARD and entry["shape"]["kind"] == "halfspace" and rng.integers(4) == 0:
        # The same plane from the other side, 2 mm too near.
        normal = [-x for x in entry["shape"]["normal"]]
        lid = {**entry, "shape": {"kind": "halfspace", "normal": normal, "offset": 0.0}}
        _put_against(case, "above", lid, -gap - 0.002, np.zeros(3))
        _add_pair(rng, case, "above", "body", 1)


def _put_against(case: Json, name: str, entry: Json, gap: float, away: Array) -> None:
    """Add a shape to a scene, at the distance `gap` [m] from the scene's shape ``"body"``.

    The added shape starts `away` [m] from the other shape, and is moved along the normal of their
    closest points.
    """
    places = kinematics(case["mechanism"], np.array(case["q"]))
    body = case["shapes"]["body"]
    pose = pose_in_world(body, places)
    R_under, t_under, _ = places[entry["body"]]
    turn, _ = frame(entry["pose"])
    start = pose[1] + away
    there = R_under @ turn, start
    phi, _, _, n = closest_points(entry["shape"], there, body["shape"], pose)
    nearest = int(np.argmin(phi))
    shift = (np.atleast_1d(phi)[nearest] - gap) * np.atleast_2d(n)[nearest]
    place = few_digits(R_under.T @ (start + shift - t_under), 6)
    case["shapes"][name] = {**entry, "pose": {**entry["pose"], "xyz": place}}


def _direction(rng: Rng) -> Array:
    way = rng.uniform(-1, 1, 3)
    return np.asarray(way / np.linalg.norm(way))


def _free(rng: Rng, shape: Json, q: list[float]) -> Json:
    """A scene of one body, that is free."""
    body = {**free_body("body0"), **mass(rng)}
    return scene([body], {"body": on("body0", shape)}, q, pairs=[])


def _bricks(rng: Rng) -> Json:
    """A brick on a brick: flush, turned by some 0.25 rad, or askew with a corner over an edge."""
    top, under = rng.choice([0.125, 0.25, 0.5], (2, 3))
    depth = float(rng.choice([0.0, 1 / 64, -1 / 1024]))
    kind = int(rng.integers(3))
    turn = Rotation.identity()
    corner = -top / 2  # that touches
    if kind == 0:
        under = np.where(rng.integers(2, size=3), top, under)
        place = (top - under) / 2 * rng.integers(-1, 2, 3)  # flush faces, or middles that meet
    elif kind == 1:
        angle = float(rng.choice([0.04, 0.1, 0.2, 0.4, 0.6])) * rng.uniform(0.9, 1.1)
        turn = Rotation.from_rotvec(angle * _direction(rng))
        corner = -np.sign(turn.as_matrix()[2]) * top / 2
        place = np.array(few_digits(rng.uniform(-0.1, 0.1, 3)))
    else:
        turn = Rotation.from_euler("zx", [rng.uniform(-1.1, -0.4), rng.uniform(-0.2, -0.02)])
        # By ASIDE off the edge, or rounding would decide which of the corner's edges crosses it.
        edge = [rng.uniform(-0.05, 0.05), under[1] / 2 + ASIDE * rng.choice([-1, 1]), 0.0]
        place = edge - turn.apply(corner)
    place[2] = under[2] / 2 - depth - turn.apply(corner)[2]
    case = _free(rng, {"kind": "box", "size": top.tolist()}, [*place, *turn.as_quat()])
    case["shapes"]["under"] = on(None, {"kind": "box", "size": under.tolist()})
    _add_pair(rng, case, "under", "body", int(rng.integers(2, 9)))
    return case


def _cloud(rng: Rng) -> Json:
    """A free cloud in a plate, flush with an edge of it, or on the axis of a capsule."""
    points, under = (_cloud_in_plate, _stl_on_plate, _points_on_axis)[int(rng.integers(3))](rng)
    cloud = {"kind": "cloud", "points": points.tolist()}
    case = _free(rng, cloud, [0.0, 0.0, 0.0, *UPRIGHT])
    case["shapes"]["under"] = on(None, under)
    _add_pair(rng, case, "under", "body", int(rng.integers(1, 5)))
    return case


def _cloud_in_plate(rng: Rng) -> tuple[Array, Json]:
    """A point on the middle plane of a plate; the others on one side, or most of them."""
    thin = int(rng.integers(3))
    size = rng.choice([0.5, 1.0], 3)
    size[thin] = 0.125
    points = rng.integers(-2, 3, (6, 3)) / 16
    one_side = np.array([0, 1, 2, 4, 4, 4]) / 16
    most = np.array([0, 3, -1, -1, -1, -1]) / 64  # the mean height says another side
    points[:, thin] = rng.choice([-1, 1]) * (one_side if rng.integers(2) else most)
    return points, {"kind": "box", "size": size.tolist()}


def _stl_on_plate(rng: Rng) -> tuple[Array, Json]:
    """A brick as an STL has it, each corner several times, on a plate and flush with its edge."""
    size = rng.choice([0.125, 0.25], 3)
    plate = np.array([1.0, 1.0, 0.125])
    corners = size * (np.indices((2, 2, 2)).reshape(3, -1).T - 0.5)
    middle = np.append(rng.choice([-1, 1], 2) * (plate - size)[:2] / 2 * rng.integers(0, 2, 2), 0.0)
    middle[2] = (plate + size)[2] / 2
    of_triangles = rng.permutation(np.repeat(corners, rng.integers(1, 7, len(corners)), axis=0))
    return middle + of_triangles, {"kind": "box", "size": plate.tolist()}


def _points_on_axis(rng: Rng) -> tuple[Array, Json]:
    """Points of which the first is on the axis of a capsule, and the others are around it."""
    points = rng.integers(-4, 5, (4, 3)) / 16
    points[0, :2] = 0.0
    return points, {"kind": "capsule", "radius": 0.0625, "length": 0.5}
