"""Random scenes of the layer `step`: mechanisms of every kind that nearly touch something.

A ball on a body and a plane, or another ball, are put where the gap between them is small; centres
of mass are not at origins, wrenches act on any body, gravity is along any direction, and targets
are near or far. Of a brick
on a box or a ball, and of a box or a cloud on a plane, several points nearly touch.
"""

import numpy as np

from quasistatic_ref.lab.program.mechanism import kinematics, slices
from quasistatic_ref.lab.program.rotation import quaternion_product, rotation
from quasistatic_ref.lab.program.step import pose_in_world
from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.challenge.random_mechanisms import (
    KINDS,
    few_digits,
    mass,
    random_follower,
    random_q,
    random_quaternion,
    random_tree,
)
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.tables import GRAVITY, free_body, link, on, scene
from quasistatic_ref.numbers.arrays import Array

CONES = ("pyramid", "pyramid", "pyramid", "product", "facets-6", "facets-8", "frictionless")
GAPS = (0.0005, 0.0, -0.0005, 0.01)
"""[m]"""


def random_scene(rng: Rng, hard: bool) -> Json:
    """The input of a case; a hard one has more bodies, or too little room."""
    kind = rng.integers(5)
    match kind:
        case 0:
            tree = [{**free_body("body0"), **mass(rng)}]
        case 1:
            stand = link("stand", None, "fixed")
            tree = [stand, *(b | mass(rng) for b in random_follower(rng, "stand"))]
        case 2:
            return _many_points(rng)
        case _:
            base = str(rng.choice(["fixed", "floating", "planar", *KINDS[:3]]))
            count = int(rng.integers(2, 5 if hard else 4))
            tree = random_tree(rng, count, base, masses=True)["bodies"]
            tree[-1]["joint"] = "revolute" if tree[-1]["joint"] == "fixed" else tree[-1]["joint"]
    if kind != 0 and hard and rng.integers(2):
        tree.append({**free_body("other"), **mass(rng)})
    bodies = {"bodies": tree}
    q = random_q(rng, bodies)
    places, n_a, _ = slices(bodies)
    n_q_a = max((i.stop for i, k in places.values() if k.stop <= n_a), default=0)
    case = scene(
        tree,
        {},
        q,
        pairs=[],
        K_q=_stiffness(rng, n_a),
        q_bar_a=_target(rng, bodies, np.array(q[:n_q_a])),
        cone=str(rng.choice(CONES)),
        gravity=GRAVITY if rng.integers(2) else few_digits(rng.uniform(-10, 10, 3), 1),
    )
    pushed = [body["name"] for body in tree if "com" in body and rng.integers(3) == 0]
    if pushed:
        case["wrenches"] = [
            {
                "body": name,
                "force": few_digits(rng.uniform(-3, 3, 3), 2),
                "torque": few_digits(rng.uniform(-0.1, 0.1, 3), 3),
            }
            for name in pushed
        ]
    _touch(rng, case, tree[-1]["name"], hard)
    return case


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


def _stiffness(rng: Rng, n_a: int) -> Json:
    """Springs of each joint alone, or a symmetric matrix: diagonally dominant, hence definite."""
    stiff = np.diag(np.round(rng.uniform(5, 500, n_a)))
    if n_a > 1 and rng.integers(3):
        between = np.triu(np.round(rng.uniform(-50, 50, (n_a, n_a))), 1)
        between += between.T
        stiff += between + np.diag(abs(between).sum(axis=1))
    return stiff.tolist()


def _pair(rng: Rng, name: str, alpha: str, beta: str, k: int = 1) -> Json:
    friction = few_digits([rng.uniform(0.1, 1), rng.uniform(0.001, 0.02)], 3)
    friction = [0.0, 0.0] if rng.integers(10) == 0 else friction
    rows = int(rng.choice([4, 6, 6]))
    pair = {"name": name, "alpha": alpha, "beta": beta, "mu_v": friction[0], "rows": rows, "k": k}
    return {**pair, "mu_omega": friction[1]}


def _plane(rng: Rng, through: list[float] | Array, depth: float) -> Json:
    """A half-space whose surface is `depth` [m] below a point; its normal has any length."""
    normal = np.array(few_digits(rng.uniform([-1.0, -1.0, -0.5], [1.0, 1.0, 1.5]), 2))
    if rng.integers(4) == 0:  # d1 is the first of equal axes
        normal = rng.permutation([normal[0], normal[0], 2 * abs(normal[0]) + 0.25])
    length = float(np.linalg.norm(normal))
    offset = few_digits([normal @ np.array(through) - length * depth], 5)[0]
    return {"kind": "halfspace", "normal": normal.tolist(), "offset": offset}


def _touch(rng: Rng, case: Json, body: str, hard: bool) -> None:
    """Put a ball on a body, and a plane or another ball where it nearly touches."""
    radius = few_digits(rng.uniform(0.02, 0.08, 1), 3)[0]
    ball = on(body, {"kind": "sphere", "radius": radius}, few_digits(rng.uniform(0, 0.1, 1))[0])
    case["shapes"]["ball"] = ball
    _, centre = pose_in_world(ball, kinematics(case["mechanism"], np.array(case["q"])))
    gap = float(rng.choice(GAPS))
    if rng.integers(3):
        case["shapes"]["floor"] = on(None, _plane(rng, centre, radius + gap))
    else:
        away = rng.uniform(-1, 1, 3)
        away *= (radius + 0.05 + gap) / np.linalg.norm(away)
        place = {"xyz": few_digits(centre - away, 5), "quaternion": random_quaternion(rng)}
        case["shapes"]["floor"] = on(None, {"kind": "sphere", "radius": 0.05}) | {"pose": place}
    alpha, beta = ("floor", "ball") if rng.integers(3) else ("ball", "floor")
    case["pairs"].append(_pair(rng, "floor", alpha, beta))
    if hard and rng.integers(3) == 0:
        case["shapes"]["lid"] = on(None, _plane(rng, centre, radius + float(rng.choice(GAPS))))
        case["pairs"].append(_pair(rng, "lid", "lid", "ball"))
    if hard and rng.integers(6) == 0:  # the same plane from the other side, 2 mm too near
        floor = case["shapes"]["floor"]["shape"]
        if floor["kind"] == "halfspace":
            length = float(np.linalg.norm(floor["normal"]))
            normal = [-x for x in floor["normal"]]
            shift = length * (2 * radius + gap - 0.002)
            lid = {"kind": "halfspace", "normal": normal, "offset": -floor["offset"] - shift}
            case["shapes"]["lid"] = on(None, lid)
            case["pairs"] = [*case["pairs"][:1], _pair(rng, "lid", "lid", "ball")]


def _many_points(rng: Rng) -> Json:
    """A brick on a box or a ball, or a box or a cloud on a plane: the nearest points are kept."""
    if rng.integers(2):
        return _brick_on_solid(rng)
    body = {**free_body("body0"), **mass(rng)}
    q = random_q(rng, {"bodies": [body]})
    shape: Json = {"kind": "box", "size": few_digits(rng.uniform(0.05, 0.2, 3), 2)}
    if rng.integers(2):
        count = int(rng.choice([2, 12]))  # also fewer than are asked for
        points = [few_digits(point) for point in rng.uniform(-0.1, 0.1, (count, 3))]
        shape = {"kind": "cloud", "points": points}
    shapes = {"body": on("body0", shape), "floor": on(None, _plane(rng, q[:3], 0.08))}
    pairs = [_pair(rng, "floor", "floor", "body", int(rng.integers(2, 5)))]
    return scene([body], shapes, q, pairs=pairs)


def _brick_on_solid(rng: Rng) -> Json:
    """A brick that is turned by more or less than 0.25 rad, on a box or a ball."""
    size = few_digits(rng.uniform(0.05, 0.2, 3), 2)
    shape: Json = {"kind": "box", "size": few_digits(rng.uniform(0.05, 0.2, 3), 2)}
    top = shape["size"][2] / 2
    if rng.integers(4) == 0:
        shape = {"kind": "sphere", "radius": 0.08}
        top = 0.08
    axis = rng.permutation([1.0, *rng.uniform(-0.9, 0.9, 2)])
    axis /= np.linalg.norm(axis)
    half_angle = float(rng.choice([0.02, 0.05, 0.1, 0.2, 0.3])) * rng.uniform(0.9, 1.1)
    turn = few_digits([*np.sin(half_angle) * axis, np.cos(half_angle)], 4)
    lowest = float(np.abs(rotation(np.array(turn))[2]) @ np.array(size)) / 2
    aside = few_digits(rng.uniform(-0.08, 0.08, 2), 3)
    height = few_digits([top + lowest + float(rng.choice(GAPS[:3]))], 5)
    body = {**free_body("body0"), **mass(rng)}
    world = random_quaternion(rng)
    place = few_digits(rotation(np.array(world)) @ [*aside, *height], 6)
    q = [*place, *few_digits(quaternion_product(np.array(world), np.array(turn)), 6)]
    under = on(None, shape) | {"pose": {"xyz": [0.0, 0.0, 0.0], "quaternion": world}}
    shapes = {"body": on("body0", {"kind": "box", "size": size}), "under": under}
    alpha, beta = ("under", "body") if rng.integers(3) else ("body", "under")
    pairs = [_pair(rng, "stack", alpha, beta, int(rng.integers(2, 9)))]
    return scene([body], shapes, q, pairs=pairs)
