"""Drawn scenes whose bodies have come to rest on flat faces: walls, towers, grids and bins."""

from itertools import combinations, product

import numpy as np

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    ContactPair,
    HalfSpace,
    PlacedShape,
    Simulator,
    Sphere,
    StepInfeasible,
    System,
)

SIDES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))
"""Normals of the walls of a bin, each 80 mm from its middle."""


def settled_step(kind, seed, count):
    """The eighth step of a scene of some bodies under gravity alone.

    Where bodies press each other into a wall, the first step without a solution is that step.
    """
    rng = np.random.default_rng(seed)
    solids, places, reach = KINDS[kind](rng, np.arange(count))
    turns = (kind == "tower") * 0.1 * np.arange(count)
    walls = [(0, 0, 1), *(SIDES if kind == "bin" else [])]
    each = enumerate(zip(solids, places, turns, strict=True))
    system = System(
        [Body.of_shape(f"b{i}", a, 0.2, xyz=xyz, rpy=(0, 0, turn)) for i, (a, xyz, turn) in each]
    )
    shapes = system.shapes
    grounds = [
        PlacedShape.in_world(f"w{k}", HalfSpace(n, -0.08 * (k > 0))) for k, n in enumerate(walls)
    ]
    pairs = [*product(grounds, shapes)]
    pairs += [
        (shapes[i], shapes[j])
        for i, j in combinations(range(count), 2)
        if np.linalg.norm(places[j] - places[i]) < reach
    ]
    mu_v = float(rng.uniform(0.3, 0.8))
    mu_omega, rows = ((0.0, 4), (0.003, 6))[int(rng.integers(2))]
    contacts = [
        ContactPair(f"p{k}", *pair, mu_v, mu_omega, rows, 4) for k, pair in enumerate(pairs)
    ]
    simulator = Simulator(system, contacts, h=0.05, certify="residual", backend="daqp")
    q = system.q_start
    try:
        for _ in range(8):
            result = simulator.step(q, [])
            q = result.q
    except StepInfeasible as proof:
        return proof.step
    return result.step


def wall(rng, k):
    """Bricks in bond: each lies on two of the course below."""
    x, _, z = half = rng.uniform(0.02, 0.05, 3)
    columns = rng.integers(2, 4)
    course = k // columns
    places = np.stack([(2 * (k % columns) + course % 2) * x, 0 * k, z * (2 * course + 1)], axis=1)
    return [Box(half)] * len(k), places, 2.1 * np.linalg.norm(half)


def tower(rng, k):
    """Boxes on each other, which are turned a little."""
    places = np.column_stack([rng.uniform(-1e-3, 1e-3, (len(k), 2)), 0.02 + 0.04 * k])
    return [Box((0.03, 0.03, 0.02))] * len(k), places, 0.05


def grid(rng, k):
    """Boxes on a floor, face to face."""
    a = rng.uniform(0.02, 0.04)
    places = a * np.stack([2 * (k % 3), 2 * (k // 3), np.ones(len(k))], axis=1)
    return [Box((a, a, a))] * len(k), places, 2.1 * a


def fallen(rng, k):
    """Boxes, balls and capsules that fall between four walls."""
    sizes = rng.uniform(0.02, 0.05, (len(k), 3))
    kinds = Box, lambda size: Sphere(size[0]), lambda size: Capsule(*size[:2])
    solids = [kinds[i % 3](size) for i, size in enumerate(sizes)]
    places = np.column_stack([rng.uniform(-0.03, 0.03, (len(k), 2)), 0.06 * (k + 1)])
    return solids, places, np.inf


KINDS = {"wall": wall, "tower": tower, "grid": grid, "bin": fallen}
"""Solids of bodies 0, 1, ..., their places [m], and how far apart neighbours are at most [m]."""
