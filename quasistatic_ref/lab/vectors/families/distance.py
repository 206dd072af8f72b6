"""Inputs of the layer `distance`: every pair, apart, near touching and in penetration; corners."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case, by_hand
from quasistatic_ref.lab.vectors.families.mechanisms import ORIGIN, random_pose
from quasistatic_ref.lab.vectors.layers.distance import answer

CLOSE = 1e-9
"""Gap of the pairs that nearly touch [m]."""

POSES = 40
"""Random poses that are tried for each kind of gap."""

SHAPES: dict[str, Json] = by_hand("distance")["shapes"]


def distance_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng = np.random.default_rng(22)
    kinds = list(SHAPES)
    for i, first in enumerate(kinds):
        for second in kinds[i:]:
            if first != "halfspace" or second != "halfspace":
                yield from _pair(rng, *((first, second) if rng.integers(2) else (second, first)))
    for kind, shape in SHAPES.items():
        points = {"kind": "cloud", "points": mixed_points(rng, 14)}
        where = {"pose_alpha": random_pose(rng, 0.2), "pose_beta": random_pose(rng, 0.02)}
        sides = {"alpha": shape, "beta": points}
        if rng.integers(2):
            sides = {"alpha": points, "beta": shape}
        provenance = f"14 points in, on and around a {kind}, its centre and axis among them"
        yield f"distance/cloud/{kind}", provenance, sides | where
    for name, corner in by_hand("distance")["corners"].items():
        poses = {pose: ORIGIN | corner.get(pose, {}) for pose in ("pose_alpha", "pose_beta")}
        provenance = corner.pop("provenance")
        yield f"distance/corner/{name}", provenance, corner | poses


def mixed_points(rng: Rng, count: int) -> list[list[float]]:
    """Points inside and outside a shape, its centre, and two on its axis among them."""
    points = np.round(rng.uniform(-0.45, 0.45, (count - 3, 3)), 3) + 0.0
    return [[0.0, 0.0, 0.0], [0.0, 0.0, 0.21], [0.0, 0.0, -0.6], *points.tolist()]


def _pair(rng: Rng, first: str, second: str) -> Iterator[Case]:
    """A pair apart, in penetration, and moved until it nearly touches."""
    name = f"distance/{first}_{second}"
    shapes = {"alpha": SHAPES[first], "beta": SHAPES[second]}
    apart = inside = None
    for _ in range(POSES):
        size = 0.5 if apart is None else 0.15
        poses = {"pose_alpha": random_pose(rng, size), "pose_beta": random_pose(rng, size)}
        try:
            phi = answer(shapes | poses)[0]["phi"][0]
        except InputError:  # no closed form, or none where the solids meet
            continue
        if phi > 0 and apart is None:
            apart = shapes | poses
        elif phi < 0 and inside is None:
            inside = shapes | poses
        if apart and (inside or not _has_depths(first, second)):
            break
    if apart:
        yield f"{name}/apart", f"a {first} and a {second} at random poses, apart", apart
        near = _nearly_touching(apart)
        yield f"{name}/near", f"the same, moved along n until {CLOSE:g} m are left", near
    if inside:
        yield f"{name}/inside", f"a {first} and a {second} at random poses, in penetration", inside


def _has_depths(first: str, second: str) -> bool:
    """Whether the pair has a closed form in penetration."""
    straight = ("box", "capsule", "convex")
    simple = ("sphere", "halfspace")
    return first in simple or second in simple or (first in straight and second in straight)


def _nearly_touching(case: Json) -> Json:
    found, _, _ = answer(case)
    pose = case["pose_beta"]
    shift = found["phi"][0] - CLOSE
    xyz = [round(x - shift * n, 13) for x, n in zip(pose["xyz"], found["n"][0], strict=True)]
    return case | {"pose_beta": pose | {"xyz": xyz}}
