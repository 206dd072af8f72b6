"""Drawn scenes whose bodies have come to rest on flat faces: walls, towers, grids and bins."""

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


def settled_step(kind, seed, count, steps=8):
    """A step of a scene of some bodies, after others under gravity alone.

    Where bodies press each other into a wall, the first step without a solution is that step.
    """
    rng = np.random.default_rng(seed)
    bodies, walls, near = KINDS[kind](rng, count)
    system = System(bodies)
    grounds = [PlacedShape.in_world(f"w{k}", HalfSpace(n, o)) for k, (n, o) in enumerate(walls)]
    shapes = system.shapes
    pairs = [(ground, shape) for ground in grounds for shape in shapes]
    pairs += [(shapes[j], shapes[i]) for i in range(count) for j in range(i) if near(i, j)]
    mu_v = float(rng.uniform(0.3, 0.8))
    mu_omega, rows = ((0.0, 4), (0.003, 6))[int(rng.integers(2))]
    contacts = [
        ContactPair(f"p{k}", alpha, beta, mu_v, mu_omega, rows, 4)
        for k, (alpha, beta) in enumerate(pairs)
    ]
    simulator = Simulator(system, contacts, h=0.05, certify="residual", backend="daqp")
    q = system.q_start
    try:
        for _ in range(steps - 1):
            q = simulator.step(q, []).q
        return simulator.step(q, []).step
    except StepInfeasible as proof:
        return proof.step


def _boxes(half, places, turns=None):
    turns = turns or [(0.0, 0.0, 0.0)] * len(places)
    both = enumerate(zip(places, turns, strict=True))
    return [Body.of_shape(f"b{i}", Box(half), 0.2, xyz=xyz, rpy=rpy) for i, (xyz, rpy) in both]


def _wall(rng, count):
    """Bricks in bond: each lies on two of the course below."""
    x, y, z = half = tuple(rng.uniform(0.02, 0.05, 3))
    columns = int(rng.integers(2, 4))
    places = []
    row = 0
    while len(places) < count:
        places += [((2 * c + row % 2) * x, 0.0, z * (2 * row + 1)) for c in range(columns)]
        row += 1
    at = np.array(places[:count])
    far = np.array([2.2 * x, y, 2.2 * z])

    def near(i, j):
        return bool((np.abs(at[i] - at[j]) < far).all())

    return _boxes(half, places[:count]), [((0, 0, 1), 0.0)], near


def _tower(rng, count):
    """Boxes on each other, each turned a little."""
    half = (0.03, 0.03, 0.02)
    shift = rng.uniform(-1e-3, 1e-3, (count, 2))
    places = [(*shift[i], 0.02 + 0.04 * i) for i in range(count)]
    turns = [(0.0, 0.0, float(rng.uniform(0.0, 0.2)) * i) for i in range(count)]
    return _boxes(half, places, turns), [((0, 0, 1), 0.0)], lambda i, j: i == j + 1


def _grid(rng, count):
    """Boxes on a floor, face to face."""
    a = float(rng.uniform(0.02, 0.04))
    places = [(2 * a * (i % 3), 2 * a * (i // 3), a) for i in range(count)]
    at = np.array(places)

    def near(i, j):
        return float(np.linalg.norm(at[i] - at[j])) < 2.1 * a

    return _boxes((a, a, a), places), [((0, 0, 1), 0.0)], near


def _bin(rng, count):
    """Boxes, balls and capsules that fall between four walls."""
    shapes = (
        lambda: Box(tuple(rng.uniform(0.02, 0.05, 3))),
        lambda: Sphere(float(rng.uniform(0.02, 0.04))),
        lambda: Capsule(float(rng.uniform(0.015, 0.03)), float(rng.uniform(0.03, 0.07))),
    )
    places = [(*rng.uniform(-0.03, 0.03, 2), 0.06 + 0.06 * i) for i in range(count)]
    bodies = [Body.of_shape(f"b{i}", shapes[i % 3](), 0.1, xyz=xyz) for i, xyz in enumerate(places)]
    walls = [
        ((0, 0, 1), 0.0),
        *((n, -0.08) for n in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))),
    ]
    return bodies, walls, lambda i, j: True


KINDS = {"wall": _wall, "tower": _tower, "grid": _grid, "bin": _bin}
