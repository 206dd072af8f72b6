"""Random pairs of all shapes at scales of 10 um to 10 m, judged in 60 digits.

    python -m validation.make.curved_pairs [--pairs N] [--seed S] [--out FILE]

The judge shares no line with the package. The gap along n of two convex solids is
s(n) = n . t - h_b(-n) - h_a(n) with the support functions h in closed form; the signed distance
is its largest value. Around the normal that the package gives, the judge follows supergradients
by the ellipsoid method in the plane of two tangents, from a radius of 1e-4 down to 1e-13, and so
finds the maximum s* of the gap, to about 1e-26, and its place n*, all in 60 digits. Over 4,000
directions it looks for a wider gap elsewhere. What is reported, relative to the pair's size L:

- phi: |phi - s*| / L;
- points: distance of alpha and beta from their surfaces, |beta - alpha - phi n|, over L;
- normal: |n - n*| times c / L, at most 1, where c, the drop of the gap per square of the angle,
  says how well the normal is determined: an angle is found to about the rounding of lengths over c;
- elsewhere: by how much a gap in another direction exceeds phi, over L.
"""

from __future__ import annotations

import argparse
import sys
from collections import defaultdict
from pathlib import Path

import flint
import numpy as np
from flint import arb
from scipy.spatial.transform import Rotation
from tqdm import tqdm

sys.path.insert(0, str(Path(__file__).parents[2]))

from quasistatic_ref.contact.shape_in_world import ShapeInWorld, Witness
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.errors import ContactError
from quasistatic_ref.shapes.convex_mesh import ConvexMesh, convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Shape,
    Sphere,
)
from tests.oracles import closest
from validation.make.pair_distances import points_off

DIGITS, RADIUS, LAST = 60, arb("1e-4"), arb("1e-13")
KINDS = ("sphere", "box", "capsule", "mesh", "cylinder", "cone", "ellipsoid")
CUTS = 400
Vector = list[arb]


def random_solid(kind: str, random: np.random.Generator, scale: float) -> Shape:
    """A solid of some kind whose lengths are within a factor of four of a scale [m]."""
    x = scale * np.exp(random.uniform(-0.7, 0.7, size=3))
    match kind:
        case "sphere":
            return Sphere(x[0])
        case "box":
            return Box(x)
        case "capsule":
            return Capsule(x[0], x[1])
        case "cylinder":
            return Cylinder(x[0], x[1])
        case "cone":
            return Cone(x[0], x[1])
        case "ellipsoid":
            return Ellipsoid(x)
    return convex_hull(random.normal(size=(20, 3)) * x)


def random_pose(
    a: Shape, b: Shape, random: np.random.Generator, scale: float
) -> tuple[np.ndarray, np.ndarray]:
    """Apart, touching or deep; every third pair with parallel axes or faces, or axes that meet."""
    turns = Rotation.create_group("O").as_matrix().round()
    R = Rotation.random(random_state=random).as_matrix()
    way = random.normal(size=3)
    if random.random() < 1 / 3:
        R = turns[random.integers(len(turns))]
    if random.random() < 1 / 3:
        way[random.integers(3)] = 0.0
    way /= np.linalg.norm(way)
    # Along `way` the solids touch at the support functions' distance or later.
    reach = float(closest.gap(a, b, R, np.zeros(3), way[None])[0])
    kind = random.integers(3)
    beyond = scale * (0.0, 10.0 ** random.uniform(-9, 0.5), -random.uniform(0, 0.8))[kind]
    return R, (beyond - reach) * way


def support(solid: Shape, n: Vector) -> Vector:
    """The farthest point along n in 60 digits."""
    radial = (n[0] * n[0] + n[1] * n[1]).sqrt()
    rim = [n[0] / radial, n[1] / radial] if radial > 0 else [arb(0), arb(0)]
    match solid:
        case Sphere() | Capsule():
            length = sum(x * x for x in n).sqrt()
            half = arb(solid.half_length) if isinstance(solid, Capsule) else arb(0)
            ball = [arb(solid.radius) * x / length for x in n]
            return [ball[0], ball[1], ball[2] + half * n[2].sgn()]
        case Box():
            return [arb(h) * x.sgn() for h, x in zip(solid.half_extents, n, strict=True)]
        case Cylinder():
            r, half = arb(solid.radius), arb(solid.half_length)
            return [r * rim[0], r * rim[1], half * n[2].sgn()]
        case Cone():
            r, half = arb(solid.radius), arb(solid.half_length)
            if 2 * half * n[2] > r * radial:
                return [arb(0), arb(0), half]
            return [r * rim[0], r * rim[1], -half]
        case Ellipsoid():
            squares = [arb(e) * arb(e) * x for e, x in zip(solid.half_axes, n, strict=True)]
            height = sum(x * y for x, y in zip(squares, n, strict=True)).sqrt()
            return [x / height for x in squares]
        case ConvexMesh():
            near = np.argsort(-(solid.vertices @ np.array([float(x) for x in n])))[:6]
            corners = [[arb(x) for x in solid.vertices[i]] for i in near]
            return max(corners, key=lambda v: sum(x * y for x, y in zip(v, n, strict=True)))
    raise AssertionError(solid)


def between(a: Shape, b: Shape, R: list[Vector], t: Vector, n: Vector) -> Vector:
    """From a's farthest point along n to b's along -n."""
    own = [-sum(R[i][j] * n[i] for i in range(3)) for j in range(3)]
    on_a, on_b = support(a, n), support(b, own)
    return [t[i] + sum(R[i][j] * on_b[j] for j in range(3)) - on_a[i] for i in range(3)]


def widest(
    a: Shape, b: Shape, R: np.ndarray, t: np.ndarray, n: np.ndarray
) -> tuple[arb, np.ndarray]:
    """The maximum of the gap near n and where it is, by the ellipsoid method in two tangents."""
    turn = [[arb(x) for x in row] for row in R.tolist()]
    shift, start = [arb(x) for x in t], [arb(x) for x in n]
    length = sum(x * x for x in start).sqrt()
    start = [x / length for x in start]
    T = [[arb(x) for x in row] for row in np.linalg.svd(n[None])[2][1:].tolist()]
    y = [arb(0), arb(0)]
    P = [[RADIUS * RADIUS, arb(0)], [arb(0), RADIUS * RADIUS]]
    best, place = arb("-inf"), start
    # A gap that is the same all along a direction, as of coaxial solids, is cut in the other only.
    for _ in range(CUTS):
        if not P[0][0] + P[1][1] > LAST * LAST:
            break
        m = [start[i] + y[0] * T[0][i] + y[1] * T[1][i] for i in range(3)]
        length = sum(x * x for x in m).sqrt()
        m = [(x / length).mid() for x in m]
        w = between(a, b, turn, shift, m)
        gap = sum(x * z for x, z in zip(w, m, strict=True))
        if gap > best:
            best, place = gap, m
        # The slope of the normalised gap in y: that of the support points across m.
        across = [w[i] - gap * m[i] for i in range(3)]
        g = [-sum(across[i] * T[k][i] for i in range(3)) for k in range(2)]
        Pg = [P[k][0] * g[0] + P[k][1] * g[1] for k in range(2)]
        norm = g[0] * Pg[0] + g[1] * Pg[1]
        if not norm > 0:
            break
        root = norm.sqrt()
        y = [(y[k] - Pg[k] / (3 * root)).mid() for k in range(2)]
        P = [
            [(arb(4) / 3 * (P[i][j] - arb(2) / 3 * Pg[i] * Pg[j] / norm)).mid() for j in range(2)]
            for i in range(2)
        ]
    return best, np.array([float(x) for x in place])


def errors(
    a: Shape, b: Shape, R: np.ndarray, t: np.ndarray, found: Witness, directions: np.ndarray
) -> dict[str, float]:
    """How wrong an answer is, relative to the pair's size."""
    size = a.extent + b.extent + float(np.abs(t).max())
    best, place = widest(a, b, R, t, found.n)
    turn = [[arb(x) for x in row] for row in R.tolist()]
    drops = []
    for way in np.linalg.svd(place[None])[2][1:]:
        for sign in (1e-4, -1e-4):
            m = [arb(x) for x in (place + sign * way) / np.hypot(1, 1e-4)]
            w = between(a, b, turn, [arb(x) for x in t], m)
            drops.append(float(best - sum(x * z for x, z in zip(w, m, strict=True))) / 1e-8)
    return {
        "phi": abs(float(arb(found.phi) - best)) / size,
        "points": points_off(a, b, R, t, found) / size,
        "normal": float(np.abs(place - found.n).max()) * min(max(min(drops) / size, 0.0), 1.0),
        "elsewhere": (closest.gap(a, b, R, t, directions).max() - found.phi) / size,
    }


def main() -> int:
    """Print the table, and write it where --out says."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    flint.ctx.dps = DIGITS
    random = np.random.default_rng(arguments.seed)
    directions = random.normal(size=(4000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    worst: dict[tuple[str, str], dict[str, float]] = defaultdict(lambda: defaultdict(float))
    by_scale: dict[int, float] = defaultdict(float)
    for _ in tqdm(range(arguments.pairs), disable=None):
        names = tuple(sorted(random.choice(KINDS, size=2), key=KINDS.index))
        exponent = int(random.integers(-5, 2))
        scale = 10.0**exponent
        a, b = (random_solid(kind, random, scale) for kind in names)
        R, t = random_pose(a, b, random, scale)
        line = worst[names]
        apart = closest.gap(a, b, R, t, directions).max() > 0
        side = "apart" if apart else "in"
        line[side] += 1
        try:
            found = solid_pair(
                "pair", ShapeInWorld(a, np.eye(3), np.zeros(3)), ShapeInWorld(b, R, t)
            )
        except ContactError:
            line[f"refused {side}"] += 1
            continue
        for name, error in errors(a, b, R, t, found, directions).items():
            line[name] = max(line[name], error)
            if name == "phi":
                by_scale[exponent] = max(by_scale[exponent], error)
    text = table(worst, by_scale, arguments.pairs)
    print(text)
    if arguments.out:
        arguments.out.write_text(text + "\n", encoding="utf-8")
    return 0


def table(
    worst: dict[tuple[str, str], dict[str, float]], by_scale: dict[int, float], count: int
) -> str:
    """Markdown."""
    columns = ("phi", "points", "normal", "elsewhere")
    counts = ("apart", "refused apart", "in", "refused in")
    lines = [
        f"{count} random pairs at scales of 10 um to 10 m; errors relative to the pair's size.",
        "",
        "| pair | " + " | ".join((*columns, *counts)) + " |",
        "|---" * (1 + len(columns) + len(counts)) + "|",
    ]
    for names in sorted(worst, key=lambda names: [KINDS.index(name) for name in names]):
        line = worst[names]
        cells = [f"{line[name]:.0e}" if line[name] > 0 else "0" for name in columns]
        cells += [f"{line[name]:.0f}" for name in counts]
        lines.append(f"| {' - '.join(names)} | " + " | ".join(cells) + " |")
    lines += ["", "| scale [m] | " + " | ".join(f"1e{k}" for k in sorted(by_scale)) + " |"]
    lines.append("|---" * (1 + len(by_scale)) + "|")
    lines.append(
        "| largest error of phi | "
        + " | ".join(f"{by_scale[k]:.0e}" for k in sorted(by_scale))
        + " |"
    )
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
