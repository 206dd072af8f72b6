"""Bodies on each other, by hand.

Columns of cubes and coins, and a box in a corner. A body is inset or flush, and d deep in what it
lies on. It goes out of all that it is in, and no farther: up by d more than the one below, which
is what is compared where faces have four contacts or more. With one contact bodies tip; what
closes no gap too many, opens none under a force, and obeys Newton's law is the one step of least
action. Newton's law, which gives the sum of the forces on each body and of their torques, is asked
of all, and so are the normals written here.

Each scene is tried in some place drawn at random: in a quarter turn of the world, moved by half a
metre or by 1e-16 m, either body of a pair alpha, free bodies in any order.
"""

from functools import partial
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Body,
    Box,
    ContactPair,
    Cylinder,
    QuasistaticError,
    Simulator,
    System,
    convex_hull,
)
from tests.contact.still import placed_shape
from tests.tolerances import CLOSED_FORM

Array = np.ndarray
H = 0.01
MASS = 1.0
HALF = 0.05
EDGE = 2 * HALF
LENGTHS = (0.0, 1e-9, 1e-6, 1e-3)
"""Insets and depths [m]."""
CONTACTS = ((1, 0.0), (4, 0.0), (8, 0.0), (12, 0.0), (4, 0.5))
"""Contacts of a pair, and mu_v."""
UP = np.array([0.0, 0.0, 1.0])
RISE = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
WEIGHT = -9.81 * MASS * RISE
STRAIGHT = np.eye(3)
TURNS = Rotation.create_group("O").as_matrix().round()
INERTIA = MASS * EDGE**2 / 6
"""Of a cube about each axis, whatever the shape [kg m^2]."""
MOTION = 3e-15
"""Of motions [m, rad], for each body: a gap is a difference of two places of a metre, each rounded
to 1e-16 m, and a turn is a difference of gaps over a tenth of a metre."""


def hull(half):
    """A frustum on its wide base."""
    corners = [[x, y, z] for r, z in ((half, -HALF), (half / 2, HALF))
               for x in (-r, r) for y in (-r, r)]  # fmt: skip
    return convex_hull(corners)


BOX = Box((HALF, HALF, HALF))


class Scene(NamedTuple):
    """Bodies of which the first N are free.

    Parameters
    ----------
    bodies : list of (shape, R, t)
    normals : dict of (alpha, beta) to ndarray, shape (3,)
        Of what touches, by numbers of bodies.
    motion : ndarray, shape (N, 6)
        What is known to happen with faces on each other [m, rad].
    load : ndarray, shape (6,) or (N, 6)
        On each free body at its centre [N, N m].
    """

    bodies: list[tuple[Any, Array, Array]]
    normals: dict[tuple[int, int], Array]
    motion: Array
    load: Array = WEIGHT


def step_of(scene, k, mu_v):
    """One step, with k contacts of a pair."""
    count = len(scene.motion)
    places = [t for _, _, t in scene.bodies[:count]]
    system = System([Body.of_shape(f"b{i}", BOX, MASS, xyz=t) for i, t in enumerate(places)])
    placed = [
        placed_shape(shape, system.link(f"b{i}/solid"), R)
        if i < count else placed_shape(shape, 0, R, t)
        for i, (shape, R, t) in enumerate(scene.bodies)
    ]  # fmt: skip
    pairs = [ContactPair(f"{a}-{b}", placed[a], placed[b], mu_v, 0.0, 4, k)
             for a, b in scene.normals]  # fmt: skip
    simulator = Simulator(system, pairs, h=H, K_q=1.0, gravity=[0.0, 0.0, 0.0], backend="none")
    # The frames of the bodies are along the world's axes, and their centres are the origins.
    force = np.broadcast_to(scene.load, scene.motion.shape).ravel()
    return simulator.step(system.q_start, np.zeros(0), force)


def wrong_words(scene, k, mu_v):
    """What differs from what is known; nothing if it is empty."""
    count = len(scene.motion)
    places = np.array([t for _, _, t in scene.bodies])
    try:
        result = step_of(scene, k, mu_v)
    except QuasistaticError as error:
        return f"{type(error).__name__}: {error}"
    c = result.step.contacts
    points = result.points
    wrench = result.solution.wrench
    bodies = np.array([[int(i) for i in name.split("/")[0].split("-")] for name in c.name])
    n = np.array([scene.normals[a, b] for a, b in bodies])
    bears = wrench[:, 2] != 0.0
    if np.abs(c.n - n)[bears].max(initial=0.0) > CLOSED_FORM:
        return "a normal"
    moved = np.zeros((len(places), 6))  # translations, then rotations
    moved[:count] = result.solution.delta_q.reshape(count, 6)
    force = (wrench[:, :3, None] * np.stack([c.d1, c.d2, n], axis=1)).sum(axis=1)
    net = np.zeros_like(moved)
    closes = points.phi.copy()
    for body, r, sign in ((bodies[:, 0], points.alpha, -1.0), (bodies[:, 1], points.beta, 1.0)):
        lever = r - places[body]
        np.add.at(net, body, sign * np.hstack([force, np.cross(lever, force)]))
        velocity = moved[body, :3] + np.cross(moved[body, 3:], lever)
        closes += sign * (n * velocity).sum(axis=1)
    needed = moved[:count] * np.repeat([MASS, INERTIA], 3) / H**2 - scene.load
    if np.abs(net[:count] - needed).max() > CLOSED_FORM * np.abs(wrench).sum():
        return "Newton's law"
    tolerance = count * MOTION
    if k > 1:
        return "motion" if np.abs(moved[:count] - scene.motion).max() > tolerance else ""
    impossible = (closes < -tolerance) | (bears & (closes > tolerance)) | (wrench[:, 2] < 0)
    return "action" if impossible.any() else ""


def turned(twists, W):
    """Motions or loads of bodies in a world that is turned by W."""
    return (twists.reshape(-1, 2, 3) @ W.T).reshape(twists.shape)


def elsewhere(scene, rng):
    """The scene in another place, either body of a pair alpha, free bodies in any order."""
    W = TURNS[rng.integers(24)]
    shift = rng.integers(-2, 3, 3) / 4 + rng.choice([0.0, 1e-16], 3)
    count = len(scene.motion)
    order = rng.permutation(count).tolist()
    bodies = [scene.bodies[i] for i in order] + scene.bodies[count:]
    number = [*np.argsort(order).tolist(), *range(count, len(bodies))]
    normals = {}
    for (a, b), n in scene.normals.items():
        side = int(rng.choice([1, -1]))
        normals[(number[a], number[b])[::side]] = side * W @ n
    return scene._replace(
        bodies=[(shape, W @ R, W @ t + shift) for shape, R, t in bodies],
        normals=normals,
        motion=turned(scene.motion, W)[order],
        load=turned(np.broadcast_to(scene.load, scene.motion.shape), W)[order],
    )


def slab():
    """What the lowest bodies stand on."""
    return Box((1.0, HALF, HALF)), STRAIGHT, -HALF * UP


def column(tall, solid, count, mu_v, inset, depth):
    """Bodies on each other: number i goes up by i + 1 depths, whatever the friction."""
    each = np.arange(count)
    middles = np.outer((each + 0.5) * tall - (each + 1) * depth, UP)
    bodies = [(solid(HALF - i * inset), STRAIGHT, middles[i]) for i in each]
    normals = {(i - 1 if i else count, i): UP for i in range(count)}
    return Scene([*bodies, slab()], normals, np.outer(depth * (each + 1), RISE))


def corner(mu_v, inset, depth):
    """A box pressed into a floor and two walls, of which it goes out along all three.

    With friction it slides on each as it leaves the others: to x = y = z with x - mu_v y = depth.
    """
    places = np.diag(np.array([inset, inset, 0.0]) + depth - EDGE)
    fixed = [(BOX, STRAIGHT, place) for place in places]
    box = Box((HALF - inset, HALF - inset, HALF))
    normals = {(i + 1, 0): way for i, way in enumerate(np.eye(3))}
    motion = depth / (1 - mu_v) * np.array([[1.0, 1.0, 1.0, 0.0, 0.0, 0.0]])
    load = WEIGHT - [1.5, 2.5, 0.0, 0.0, 0.0, 0.0]
    return Scene([(box, STRAIGHT, np.zeros(3)), *fixed], normals, motion, load)


COLUMNS = {
    "cubes": partial(column, EDGE, lambda half: Box((half, half, HALF))),
    "coins": partial(column, EDGE / 10, lambda half: Cylinder(half, HALF / 10)),
}
FAMILIES = {
    f"{count} {kind}": partial(of, count) for kind, of in COLUMNS.items() for count in (2, 10)
} | {"a box in a corner": corner}


def attempts(name):
    """The scenes of a family, with contacts of a pair and mu_v."""
    for inset, depth, (k, mu_v) in product(LENGTHS, LENGTHS, CONTACTS):
        yield FAMILIES[name](mu_v, inset, depth), k, mu_v
