"""Closest points of solids in compiled code, which are to have the bits of the plain path.

    python -m validation.make.solid_pairs [--count POSES] [--out FILE]

Of each pair of shapes as many poses: random ones, axes along each other's, tilts of a millionth
(tests/oracles/closest.py), three in four of them put so that the solids touch, or nearly, or are
1 mm deep, some with their middles in one place; anywhere in the world. One contact;
either solid is alpha. Two shapes are meshes, one of them a prism, whose faces are coplanar
triangles. What compiled code leaves to Python is counted; of what it says every bit is
compared. Exit status 1 if a bit differs.
"""

import itertools
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref import ContactError, ContactPair, PlacedShape, convex_hull
from quasistatic_ref.contact.distance import joined_contacts, pair_closest_points
from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.optional.fast.compiled.solids import measured
from quasistatic_ref.shapes.placed_shape import Shape
from tests.oracles import closest
from tests.oracles.posed_pairs import PosedPairs
from validation.tools.scripts import script_options, show_page

Array = np.ndarray
GAPS = (0.0, 1e-16, 1e-13, -1e-13, 1e-9, -1e-9, 1e-6, -1e-3)
"""Signed distances at which solids are put [m]; in between they stay where they are."""
MIDDLES = (0.0, 1e-13, 1e-10)
"""Distances of the middles of solids that are all but in one place [m]."""
KEPT = (1,)
COLUMNS = ("poses", "decided", "refused", "different", "compiled [us]", "plain [us]")
INTRODUCTION = """# Pairs of solids in compiled code

Contacts of pairs of solids by C against those of the plain path, bit by bit, signs of zeros
included, in random, aligned, touching and deep poses (`python -m validation.make.solid_pairs`).
*Decided* are by C, the others by Python; *refused* by both, because the normal is not defined.
Times of a pair are upper bounds: the machine did other work meanwhile.
"""


def solids() -> dict[str, Shape]:
    """One of each kind, and a mesh with faces of several triangles, some along axes."""
    angle = np.arange(6) * np.pi / 3
    rim = 0.06 * np.column_stack([np.cos(angle), np.sin(angle)]).round(2)
    ends = [np.column_stack([rim, np.full(len(rim), z)]) for z in (0.0, 0.1)]
    return {**closest.solids(), "prism": convex_hull(np.concatenate(ends))}


def compiled_pairs() -> list[tuple[str, str]]:
    """Names of the shapes of each pair that compiled code measures."""
    shapes = solids()
    every = itertools.combinations_with_replacement(shapes, 2)
    some = [pair for pair in every if pair != ("half-space", "half-space")]
    return [pair for pair in some if measured(pair_of(*(shapes[name] for name in pair), 1))]


def pair_of(a: Shape, b: Shape, k: int) -> ContactPair:
    """A contact pair of two shapes on two links."""
    sides = [
        PlacedShape(f"s{link}", link, np.eye(3), np.zeros(3), shape)
        for link, shape in enumerate((a, b))
    ]
    return ContactPair("pair", *sides, 0.5, 0.0, 4, k)


def poses(a: Shape, b: Shape, count: int, seed: int) -> Iterator[tuple[Array, Array]]:
    """Poses of two links, R (2, 3, 3) and t (2, 3) [m]."""
    random = np.random.default_rng([39, seed])
    here = ShapeInWorld(a, np.eye(3), np.zeros(3))
    for i, (R, t) in enumerate(closest.poses(count, seed)):
        if i % 16 == 4:
            t = random.choice(MIDDLES) * random.normal(size=3)
        if i % 4:
            try:
                found = solid_pair("pair", here, ShapeInWorld(b, R, t))
                t = t + (random.choice(GAPS) - found.phi) * found.n
            except ContactError:
                pass
        W = closest.TURNS[random.integers(24)] if i % 3 else Rotation.random(rng=random).as_matrix()
        shift = (random.integers(-2, 3, 3) / 4) * (i % 5 != 0)
        yield np.stack([W, W @ R]), np.stack([shift, W @ t + shift])


def pose_counts(a: Shape, b: Shape, count: int, seed: int) -> Counter[str]:
    """How many poses were tried, decided in C and refused, how many differ, and times [s]."""
    pairs = [pair_of(*sides, k) for sides in ((a, b), (b, a)) for k in KEPT]
    by_c = [PosedPairs([pair], 2) for pair in pairs]
    tally = Counter(poses=0, decided=0, refused=0, different=0)
    for number, (R, t) in enumerate(poses(a, b, count, seed)):
        i = number // 2 % len(pairs)  # aligned poses are every other one
        start = time.perf_counter()
        found, by_itself = by_c[i].decided(R, t)
        decided = len(by_itself)
        between = time.perf_counter()
        try:
            expected = joined_contacts([pair_closest_points(pairs[i], R, t)])
        except ContactError:
            expected = None
        tally["plain"] += time.perf_counter() - between
        tally["compiled"] += between - start
        tally["poses"] += 1
        tally["decided"] += decided
        tally["refused"] += expected is None
        same = expected is not None and all(
            one.tobytes() == other.tobytes() for one, other in zip(found, expected, strict=True)
        )
        tally["different"] += decided and not same
    return tally


def main() -> int:
    """Try all pairs, and write the page; exit status 1 if a bit differs."""
    options = script_options(__doc__, count=10_000, out=Path)
    shapes = solids()
    rows = []
    different = 0
    for seed, (first, second) in enumerate(compiled_pairs()):
        tally = pose_counts(shapes[first], shapes[second], options.count, seed)
        numbers = [tally[name] for name in COLUMNS[:4]]
        us = [f"{1e6 * tally[name] / tally['poses']:.0f}" for name in ("compiled", "plain")]
        rows.append((f"{first} - {second}", *numbers, *us))
        different += tally["different"]
        print(*rows[-1], flush=True)
    table = markdown_table(("pair", *COLUMNS), rows)
    show_page("\n".join([INTRODUCTION, *table]), options.out)
    return int(different > 0)


if __name__ == "__main__":
    sys.exit(main())
