"""Bodies that lie flat on each other, by hand: ``python -m validation.make.forces_by_hand``.

Columns of cubes and coins, walls, a box in a corner and every pair of shapes base on base. Each
base is smaller than what it lies on by an inset, and d deep in it. A body goes out of all that it
is in, and no farther: up by d more than the one below, which is what is compared where faces have
four contacts or more. With one contact bodies tip; what closes no gap too many, opens none under a
force, and obeys Newton's law is the one step of least action. Newton's law, which gives the sum of
the forces on each body and of their torques, is asked of all, and so are the normals written here.
Prints validation/results/forces_by_hand.md; exit status 1 if anything is wrong.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import combinations, product

import numpy as np
from tqdm import tqdm

from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.shapes.placed_shape import Box, Cylinder, Shape
from validation.make.aligned_poses import (
    EDGE,
    FLAT,
    HALF,
    LENGTHS,
    UP,
    WEIGHT,
    Array,
    Scene,
    on_top,
    wrong,
)

CONTACTS = ((1, 0.0), (4, 0.0), (8, 0.0), (12, 0.0), (4, 0.5))
"""Contacts of a pair, and mu_v."""
INTRODUCTION = """# Forces by hand

Bodies that lie on each other with k = 1, 4, 8 and 12 contacts without friction and with four of
friction 0.5, with insets and depths of 0, 1e-9, 1e-6 and 1e-3 m
(`python -m validation.make.forces_by_hand`, whose first lines say what is asked). Left out are
clouds that are as deep as their inset, whose points have faces of their own, and walls with
friction whose cubes push aside those that they slide past.
"""


def slab() -> tuple[Shape, Array, Array]:
    """What the lowest bodies stand on."""
    return Box(np.array([1.0, HALF, HALF])), np.eye(3), -HALF * UP


def column(kind: str, count: int, tall: float, inset: float, depth: float) -> Scene:
    """Bodies on each other: number i goes up by i + 1 depths."""
    bodies = []
    for i in range(count):
        half = HALF - i * inset
        middle = (i + 0.5) * tall - (i + 1) * depth
        shape = (
            Cylinder(half, tall / 2) if kind == "coin" else Box(np.array([half, half, tall / 2]))
        )
        bodies.append((shape, np.eye(3), middle * UP))
    normals = {(i - 1 if i else count, i): UP for i in range(count)}
    return Scene([*bodies, slab()], normals, np.outer(depth * np.arange(1, count + 1), UP))


def wall(rows: Sequence[Sequence[float]], inset: float, depth: float) -> Scene:
    """Cubes in rows, whose middles are at these multiples of their edge: row r goes up by r + 1."""
    at = [(x, r) for r, row in enumerate(rows) for x in row]
    half = HALF - inset
    count = len(at)
    places = [np.array([x * EDGE, 0.0, (r + 0.5) * EDGE - (r + 1) * depth]) for x, r in at]
    brick = Box(np.array([half, HALF, HALF]))
    normals = {(count, j): UP for j, (_, r) in enumerate(at) if r == 0}
    for (i, (x, r)), (j, (y, s)) in combinations(enumerate(at), 2):
        along = abs(y - x)
        up = s - r
        if along <= 1 and up <= 1:
            edges = along == up == 1 and inset == depth == 0.0  # no gap is larger: the bisector
            way = np.array([np.sign(y - x) * (along == 1), 0.0, float(along < 1 or edges)])
            normals[i, j] = way / np.linalg.norm(way)
    bodies = [(brick, np.eye(3), place) for place in places]
    motion = np.array([(r + 1) * depth * UP for _, r in at])
    return Scene([*bodies, slab()], normals, motion)


def corner(mu_v: float, inset: float, depth: float) -> Scene:
    """A box pressed into a floor and two walls, of which it goes out along all three.

    With friction it slides on each as it leaves the others: to x = y = z with x - mu_v y = depth.
    """
    sides = [(inset, inset, 0.0)[i] + depth - EDGE for i in range(3)]
    fixed = [
        (FLAT["box"](HALF), np.eye(3), at * way) for at, way in zip(sides, np.eye(3), strict=True)
    ]
    box = Box(np.array([HALF - inset, HALF - inset, HALF]))
    normals = {(i + 1, 0): np.eye(3)[i] for i in range(3)}
    motion = np.full((1, 3), depth / (1 - mu_v))
    return Scene([(box, np.eye(3), np.zeros(3)), *fixed], normals, motion, [-1.5, -2.5, WEIGHT[2]])


BOND = [(0, 1, 2), (0.5, 1.5), (1,)]
FLUSH = [(0, 1), (0, 1)]
FAMILIES: dict[str, Callable[[float, float], Scene]] = {
    "two cubes": partial(column, "cube", 2, EDGE),
    "ten cubes": partial(column, "cube", 10, EDGE),
    "two coins": partial(column, "coin", 2, EDGE / 10),
    "ten coins": partial(column, "coin", 10, EDGE / 10),
    "a brick bond": partial(wall, BOND),
    "a flush wall": partial(wall, FLUSH),
    "a box in a corner": partial(corner, 0.0),
    **{
        f"{top} on {low}": partial(on_top, low, top)
        for low, top in product(FLAT, repeat=2) if low != "cloud"
    },
}  # fmt: skip


def attempts(name: str) -> Iterator[tuple[Scene, int, float]]:
    """The scenes of a family, with contacts of a pair and mu_v."""
    for inset, depth, (k, mu_v) in product(LENGTHS, LENGTHS, CONTACTS):
        if name.startswith("cloud") and 0.0 < depth >= inset:
            continue  # its points have faces of their own
        if name == "a flush wall" and mu_v * depth > 2 * inset:
            continue  # cubes slide past those above their neighbours, and push them aside
        of_friction = {"a box in a corner": partial(corner, mu_v)}
        yield of_friction.get(name, FAMILIES[name])(inset, depth), k, mu_v


def main() -> int:
    """Print the page; exit status 1 if anything is wrong."""
    rows = []
    found = list[str]()
    for name in tqdm(FAMILIES):
        said = [wrong(*attempt) for attempt in attempts(name)]
        found += [f"- {name}: {problem}" for problem in said if problem]
        rows.append((name, len(said), sum(map(bool, said))))
    table = markdown_table(("bodies", "scenes", "wrong"), rows, left=1)
    print(INTRODUCTION, *table, *found, sep="\n")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
