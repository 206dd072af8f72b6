"""Bodies that lie on each other, in aligned poses: ``python -m validation.make.aligned_poses``.

What is expected is written here by hand, and none of it is computed by the package: a body d deep
is lifted by d and nothing else, under m g + m d / h^2 along the normal of the surface it lies on;
edges of a flush grid touch along the bisector, and are refused where they are equally deep; two
bodies move alike whichever is alpha, whatever comes first, wherever they are and however turned.
``--count`` is that of all scenes.
"""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ContactError, QuasistaticError
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    PlacedShape,
    PointCloud,
    Shape,
    Sphere,
)
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.tolerances import CLOSED_FORM
from validation.tools.scripts import asked, shown

Array = np.ndarray
H = 0.01
G = 9.81
MASS = 1.0
HALF = 0.05
EDGE = 2 * HALF
LENGTHS = (0.0, 1e-9, 1e-6, 1e-3)
"""Insets and depths [m]."""
INTRODUCTION = """# Aligned poses

Bodies that lie on each other, flush or inset, by 0, 1e-9, 1e-6 or 1e-3 m, and as deep, in 24
quarter turns of the world and at places that are moved by 1e-16 m, either one being alpha
(`python -m validation.make.aligned_poses`). *Alike* are two free bodies, four times each: swapped,
relabelled, moved and turned.
"""
UP = np.array([0.0, 0.0, 1.0])
OVER = np.diag([1.0, -1.0, -1.0])
TURNS = list(Rotation.create_group("O").as_matrix().round())
WEIGHT = np.array([0.0, 0.0, -MASS * G])
INERTIA = MASS * EDGE**2 / 6
"""Of a cube about each axis, whatever the shape [kg m^2]."""
MOTION = 1e-15
"""Of motions [m, rad], which are differences of places of a metre."""
ALIKE = 1e-9
"""Relative difference of equal motions of two free bodies."""


def hull(half: float, far: float, points: np.random.Generator | None = None) -> Shape:
    """A frustum on its wide base; its vertices in another order if there is a generator."""
    corners = [[x, y, z] for r, z in ((half, -HALF), (far, HALF)) for x in (-r, r) for y in (-r, r)]
    return convex_hull(corners if points is None else points.permutation(corners))


SQUARE = ("box", "hull", "cloud")
FLAT: dict[str, Callable[[float], Shape]] = {
    "box": lambda half: Box(np.array([half, half, HALF])),
    "hull": lambda half: hull(half, half / 2),
    "cylinder": lambda half: Cylinder(half, HALF),
    "cone": lambda half: Cone(half, HALF),
    "cloud": lambda half: PointCloud(
        np.array([[x, y, z] for x in (-half, half) for y in (-half, half) for z in (-HALF, HALF)])
    ),
}
ROUND: dict[str, Shape] = {
    "sphere": Sphere(HALF),
    "capsule": Capsule(HALF / 2, HALF / 2),
    "ellipsoid": Ellipsoid(np.array([0.04, 0.03, HALF])),
}
SIDES = ((1, 0), (0, 1))
"""Who is alpha and who beta of two bodies."""
TIPPED = ("hull", "cone")
"""Shapes that lie on their base only: below others they are turned over."""


class Scene(NamedTuple):
    """Bodies of which the first N are free.

    Parameters
    ----------
    bodies : list of (Shape, R, t)
    normals : dict of (alpha, beta) to ndarray, shape (3,)
        Of what touches, by numbers of bodies.
    motion : ndarray, shape (N, 3)
        What is known to happen with faces on each other [m].
    load : ndarray, shape (3,)
        On each body [N].
    tips : bool
        Whether with one contact a pair bodies tip, so that the motion is not known.
    """

    bodies: list[tuple[Shape, Array, Array]]
    normals: dict[tuple[int, int], Array]
    motion: Array
    load: Array = WEIGHT
    tips: bool = True


def solid(kind: str, half: float) -> Shape:
    """A shape whose base, if it has one, is so wide."""
    return FLAT[kind](half) if kind in FLAT else ROUND[kind]


def on_top(low: str, top: str, inset: float, depth: float) -> Scene:
    """A body on another; the corners of a square base are on the rim of a circular one."""
    on_rim = top in SQUARE and low in FLAT and low not in SQUARE
    half = HALF / np.sqrt(2) - 1e-12 if on_rim else HALF
    bodies = [
        (solid(top, half - inset), np.eye(3), (EDGE - depth) * UP),
        (solid(low, HALF), OVER if low in TIPPED else np.eye(3), np.zeros(3)),
    ]
    return Scene(bodies, {(1, 0): UP}, depth * UP[None], tips=low in FLAT and top in FLAT)


def step_of(
    bodies: Sequence[tuple[Shape, Array, Array]],
    free: int,
    pairs: Iterable[tuple[int, int]],
    k: int,
    mu_v: float,
    forces: Sequence[Array] = (),
    gravity: Sequence[float] = (0.0, 0.0, 0.0),
) -> StepResult:
    """One step of bodies (shape, R, t), of which the first ones are free, in pairs of them."""
    cube = FLAT["box"](HALF)
    made = [Body.of_shape(f"b{i}", cube, MASS, xyz=t) for i, (_, _, t) in enumerate(bodies[:free])]
    system = System(made)
    placed = [
        PlacedShape(f"s{i}", system.link(f"b{i}/solid"), R, np.zeros(3), shape)
        if i < free else PlacedShape(f"s{i}", 0, R, t, shape)
        for i, (shape, R, t) in enumerate(bodies)
    ]  # fmt: skip
    contacts = [ContactPair(f"{a}-{b}", placed[a], placed[b], mu_v, 0.0, 4, k) for a, b in pairs]
    simulator = Simulator(
        system, contacts, h=H, K_q=np.zeros((0, 0)), gravity=list(gravity), backend="none"
    )
    q = system.q_start
    load = np.zeros(system.n_v)
    for i, force in enumerate(forces):
        load += system.centre_of_mass_force(q, f"b{i}", force[:3], force[3:])
    return simulator.step(q, np.zeros(0), load)


def wrong(scene: Scene, k: int, mu_v: float) -> str:
    """What differs from what is known; nothing if it is empty."""
    count = len(scene.motion)
    places = np.array([t for _, _, t in scene.bodies])
    gravity = (np.asarray(scene.load) / MASS).tolist()
    try:
        result = step_of(scene.bodies, count, scene.normals, k, mu_v, gravity=gravity)
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
    asked = moved[:count] * np.repeat([MASS, INERTIA], 3) / H**2
    asked[:, :3] -= scene.load
    if np.abs(net[:count] - asked).max() > CLOSED_FORM * np.abs(wrench).sum():
        return "Newton's law"
    if k > 1 or not scene.tips:
        known = np.hstack([scene.motion, np.zeros_like(scene.motion)])
        return "motion" if np.abs(moved[:count] - known).max() > MOTION else ""
    impossible = (closes < -MOTION) | (bears & (closes > MOTION)) | (wrench[:, 2] < 0)
    return "action" if impossible.any() else ""


def world_of(rng: np.random.Generator) -> tuple[Array, Array]:
    """A quarter turn, and a place that is moved by about the last bit of it, or not."""
    shift = rng.integers(-2, 3, 3) / 4 + rng.choice([0.0, 1e-16], 3)
    return TURNS[rng.integers(24)], shift


def elsewhere(scene: Scene, rng: np.random.Generator) -> Scene:
    """A scene of two bodies, turned and moved with the world; either one is alpha."""
    W, shift = world_of(rng)
    bodies = [(shape, W @ R, W @ t + shift) for shape, R, t in scene.bodies]
    n = W @ UP
    normals = {(1, 0): n} if rng.integers(2) else {(0, 1): -n}
    return Scene(bodies, normals, scene.motion @ W.T, W @ scene.load, scene.tips)


def lying(low: str, top: str, inset: float, depth: float, k: int, rng: np.random.Generator) -> str:
    """What is wrong with a body that lies on a fixed one; nothing if it is empty."""
    scene = on_top(low, top, inset, depth)
    if top not in TIPPED and top not in ROUND:
        (shape, _, place), below = scene.bodies
        quarter = Rotation.from_rotvec([0, 0, rng.integers(4) * np.pi / 2]).as_matrix().round()
        scene = scene._replace(bodies=[(shape, quarter, place), below])
    return wrong(elsewhere(scene, rng), k, float(rng.choice([0.0, 0.5])))


def lyings() -> list[tuple[str, str]]:
    """Every pair of shapes, the lower one first; a cloud touches solids that are flat above."""
    every = itertools.product((*FLAT, *ROUND), repeat=2)
    return [(low, top) for low, top in every if low != "cloud" and (low in FLAT or top != "cloud")]


def lying_anyhow(low: str, top: str, rng: np.random.Generator) -> str:
    """What is wrong with such a pair, inset and as deep as it may be."""
    flat = low in FLAT and top in FLAT
    k = int(rng.choice([4, 8, 12] if flat else [1, 4, 8, 12]))
    inset = float(rng.choice(LENGTHS)) if flat else 0.0
    depth = float(rng.choice(LENGTHS if flat else LENGTHS[:3]))
    # The points of a cloud have their own faces.
    return lying(low, top, inset, 0.0 if top == "cloud" else depth, k, rng)


def beside(rng: np.random.Generator) -> str:
    """A box that overhangs another along one side and is flush along the other."""
    depth = float(rng.choice(LENGTHS))
    off = float(rng.choice([1e-9, 1e-6, 1e-3, 0.03]))
    box = FLAT["box"](HALF)
    below = box if rng.integers(2) else hull(HALF, HALF)
    bodies = [
        (box, np.eye(3), np.array([off, 0.0, EDGE - depth])),
        (below, np.eye(3), np.zeros(3)),
    ]
    scene = Scene(bodies, {(1, 0): UP}, depth * UP[None])
    return wrong(elsewhere(scene, rng), int(rng.choice([4, 8])), float(rng.choice([0.0, 0.5])))


def on_edge(rng: np.random.Generator) -> str:
    """Edge on edge of a grid: the bisector where they touch, refused where they are deeper."""
    W, shift = world_of(rng)
    depth = float(rng.choice([0.0, 0.0, 1e-6, 1e-3]))
    box = FLAT["box"](HALF)
    place = W @ [EDGE - depth, 0.0, EDGE - depth] + shift
    side = SIDES[rng.integers(2)]
    try:
        result = step_of(
            [(box, W, place), (box, W, shift)], 1, [side], int(rng.choice([1, 4])), 0.0
        )
    except ContactError as error:
        return "" if depth and "as deep" in str(error) else "refused"
    if depth:
        return "not refused"
    along = W @ [np.sqrt(0.5), 0.0, np.sqrt(0.5)] * (side[0] - side[1])
    return "" if np.abs(result.points.n - along).max() < 1e-9 else "normal"


def alike(rng: np.random.Generator) -> str:
    """Two free bodies pressed together: the same motion swapped, in another order and elsewhere."""
    low, top = (str(rng.choice([kind for kind in FLAT if kind != "cloud"])) for _ in range(2))
    depth = float(rng.choice(LENGTHS))
    round_low = low not in SQUARE
    half = (
        HALF / np.sqrt(2) - 1e-6
        if top in SQUARE and round_low
        else HALF - float(rng.choice(LENGTHS))
    )
    below = FLAT[low](HALF)
    above = FLAT[top](half)
    R_low = OVER if low in TIPPED else np.eye(3)
    at = np.array([0.0, 0.0, EDGE - depth])
    press = np.array([*rng.uniform(-3, 3, 2), -20.0, *rng.uniform(-0.1, 0.1, 3)])
    moves = []
    for _ in range(4):
        W, shift = world_of(rng)
        if low == "hull":
            below = hull(HALF, HALF / 2, rng)
        if top == "hull":
            above = hull(half, half / 2, rng)
        pair = [(below, W @ R_low, shift), (above, W, W @ at + shift)]
        force = [np.zeros(6), np.concatenate([W @ press[:3], W @ press[3:]])]
        order = [0, 1] if rng.integers(2) else [1, 0]
        forces = [force[i] for i in order]
        side = SIDES[rng.integers(2)]
        result = step_of([pair[i] for i in order], 2, [side], 64, 0.0, forces)
        # The frames of the links stay along the world's axes: twists turn with the world.
        parts = result.solution.delta_q.reshape(2, 2, 3)[np.argsort(order)]
        moves.append(parts @ W)
    size = max(np.abs(moves[0]).max(), 1e-12)
    spread = max(np.abs(other - moves[0]).max() for other in moves[1:])
    return "" if spread <= ALIKE * size + 1e-13 else "motion"


def attempt(scene: Callable[[], str]) -> str:
    """What is wrong with a scene; an error that the package raises is wrong, too."""
    try:
        return scene()
    except QuasistaticError as error:
        return f"{type(error).__name__}: {error}"


def tries(scenes: Iterable[int]) -> tuple[Counter[str], list[tuple[str, str]]]:
    """How many scenes of each family were tried, and what is wrong: the family, and the problem.

    A scene depends on its number alone.
    """
    tried = Counter[str]()
    faults = list[tuple[str, str]]()
    pairs = lyings()
    others = (("overhanging", beside), ("edge on edge", on_edge), ("alike", alike))
    for i in scenes:
        rng = np.random.default_rng([32, i])
        if i % 7 == 6:
            name, own = others[i // 7 % 3]
            problem = attempt(partial(own, rng))
        else:
            low, top = pairs[i % len(pairs)]
            name = "flat on flat" if low in FLAT and top in FLAT else "round"
            problem = attempt(partial(lying_anyhow, low, top, rng))
        tried[name] += 1
        if problem:
            faults.append((name, problem))
            print(f"scene {i}, {name}: {problem}", flush=True)
    return tried, faults


def main() -> None:
    """Try all families and write the page."""
    options = asked(__doc__, count=10_500, out=Path)
    tried, faults = tries(range(options.count))
    broke = Counter(name for name, _ in faults)
    rows = [(name, tried[name], broke[name]) for name in sorted(tried)]
    total = ("all", sum(tried.values()), len(faults))
    table = markdown_table(("family", "scenes", "wrong"), [*rows, total])
    shown("\n".join([INTRODUCTION, *table]), options.out)


if __name__ == "__main__":
    main()
