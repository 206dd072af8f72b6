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
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

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
FORCE, MOTION, ALIKE = 1e-9, 1e-12, 1e-9
"""Relative error of a force; of a motion [m, rad]; relative difference of equal motions. Places of
half a metre are right to 1e-16, forces to that over h^2, and a motion of 1 mm to 1e-13."""


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
TIPPED = ("hull", "cone")
"""Shapes that lie on their base only: below others they are turned over."""


def step_of(
    bodies: list[tuple[Shape, Array, Array]],
    fixed: tuple[Shape, Array, Array] | None,
    k: int,
    mu_v: float,
    force: list[Array],
    swapped: bool = False,
) -> tuple[System, StepResult]:
    """One step of one free body (shape, R, t) on a fixed one, or of two on each other."""
    made = [
        Body.of_shape(f"b{i}", FLAT["box"](HALF), MASS, xyz=t) for i, (_, _, t) in enumerate(bodies)
    ]
    system = System(made)
    sides = [
        PlacedShape(f"b{i}", system.link(f"b{i}/solid"), R, np.zeros(3), shape)
        for i, (shape, R, _) in enumerate(bodies)
    ]
    if fixed is not None:
        shape, R, t = fixed
        sides.append(PlacedShape("fixed", 0, R, t, shape))
    alpha, beta = sides if swapped else sides[::-1]
    pair = ContactPair("p", alpha, beta, mu_v, 0.0, 4, k)
    simulator = Simulator(
        system, [pair], h=H, K_q=np.zeros((0, 0)), gravity=[0.0, 0.0, 0.0], backend="none"
    )
    q = system.q_start
    load = sum(system.centre_of_mass_force(q, f"b{i}", f[:3], f[3:]) for i, f in enumerate(force))
    return system, simulator.step(q, np.zeros(0), load)


def world_of(rng: np.random.Generator) -> tuple[Array, Array]:
    """A quarter turn, and a place that is moved by about the last bit of it, or not."""
    shift = rng.integers(-2, 3, 3) / 4 + rng.choice([0.0, 1e-16], 3)
    return TURNS[rng.integers(24)], shift


def lying(low: str, top: str, inset: float, depth: float, k: int, rng: np.random.Generator) -> str:
    """What is wrong with a body that lies on a fixed one; nothing if it is empty."""
    W, shift = world_of(rng)
    half_low = half_top = HALF
    if low in FLAT and top in FLAT and (top in SQUARE) != (low in SQUARE):
        # Square on circular: the corners on the rim; circular on square: within.
        half_top = HALF / np.sqrt(2) - 1e-12 if top in SQUARE else HALF
    below = FLAT[low](half_low) if low in FLAT else ROUND[low]
    above = FLAT[top](half_top - inset) if top in FLAT else ROUND[top]
    turned = OVER if low in TIPPED else np.eye(3)
    quarter = (
        TURNS[0]
        if top in TIPPED or top in ROUND
        else np.round(Rotation.from_rotvec([0, 0, rng.integers(4) * np.pi / 2]).as_matrix())
    )
    place = W @ [0.0, 0.0, EDGE - depth] + shift
    n = W @ UP
    mu_v = float(rng.choice([0.0, 0.5]))
    weight = np.concatenate([-MASS * G * n, np.zeros(3)])
    _, result = step_of(
        [(above, W @ quarter, place)], (below, W @ turned, shift), k, mu_v, [weight],
        bool(rng.integers(2)),
    )  # fmt: skip
    return judged(result, n, depth)


def judged(result: StepResult, n: Array, depth: float) -> str:
    """What differs from a body that is lifted by its depth."""
    c = result.step.contacts
    wrench = result.solution.wrench
    loaded = wrench[:, 2] > FORCE * wrench[:, 2].max(initial=0.0)
    if not loaded.any() or (np.abs(np.abs(c.n[loaded] @ n) - 1.0) > 1e-9).any():
        return "normal"
    expected = MASS * (G + depth / H**2)
    if abs(wrench[:, 2].sum() - expected) > FORCE * expected:
        return "force"
    off = result.solution.delta_q - np.concatenate([depth * n, np.zeros(3)])
    return "motion" if np.abs(off).max() > MOTION else ""


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
    W, shift = world_of(rng)
    depth = float(rng.choice(LENGTHS))
    off = float(rng.choice([1e-9, 1e-6, 1e-3, 0.03]))
    n = W @ UP
    box = FLAT["box"](HALF)
    place = W @ [off, 0.0, EDGE - depth] + shift
    weight = np.concatenate([-MASS * G * n, np.zeros(3)])
    kind = rng.choice(["box", "hull"])
    below = box if kind == "box" else hull(HALF, HALF)
    _, result = step_of([(box, W, place)], (below, W, shift), int(rng.choice([4, 8])),
                        float(rng.choice([0.0, 0.5])), [weight], bool(rng.integers(2)))  # fmt: skip
    return judged(result, n, depth)


def on_edge(rng: np.random.Generator) -> str:
    """Edge on edge of a grid: the bisector where they touch, refused where they are deeper."""
    W, shift = world_of(rng)
    depth = float(rng.choice([0.0, 0.0, 1e-6, 1e-3]))
    box = FLAT["box"](HALF)
    place = W @ [EDGE - depth, 0.0, EDGE - depth] + shift
    swapped = bool(rng.integers(2))
    try:
        _, result = step_of([(box, W, place)], (box, W, shift), int(rng.choice([1, 4])), 0.0,
                            [np.zeros(6)], swapped)  # fmt: skip
    except ContactError as error:
        return "" if depth and "as deep" in str(error) else "refused"
    if depth:
        return "not refused"
    along = W @ [np.sqrt(0.5), 0.0, np.sqrt(0.5)] * (-1.0 if swapped else 1.0)
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
        _, result = step_of([pair[i] for i in order], None, 64, 0.0,
                                 [force[i] for i in order], bool(rng.integers(2)))  # fmt: skip
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
    wrong = list[tuple[str, str]]()
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
            wrong.append((name, problem))
            print(f"scene {i}, {name}: {problem}", flush=True)
    return tried, wrong


def main() -> None:
    """Try all families and write the page."""
    options = asked(__doc__, count=10_500, out=Path)
    tried, wrong = tries(range(options.count))
    broke = Counter(name for name, _ in wrong)
    rows = [(name, tried[name], broke[name]) for name in sorted(tried)]
    total = ("all", sum(tried.values()), len(wrong))
    table = markdown_table(("family", "scenes", "wrong"), [*rows, total])
    shown("\n".join([INTRODUCTION, *table]), options.out)


if __name__ == "__main__":
    main()
