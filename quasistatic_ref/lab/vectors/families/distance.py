"""Inputs of the layer `distance`: every pair, apart, near touching and in penetration; corners."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.families.curved_corners import CURVED_CORNERS
from quasistatic_ref.lab.vectors.families.mechanisms import random_pose
from quasistatic_ref.lab.vectors.families.polytope_corners import POLYTOPE_CORNERS
from quasistatic_ref.lab.vectors.families.shapes import SHAPES, Table, cloud, mixed_points
from quasistatic_ref.lab.vectors.layers.distance import answer

Case = tuple[str, str, Table]

CLOSE = 1e-9
"""Gap of the pairs that nearly touch [m]."""

POSES = 40
"""Random poses that are tried for each kind of gap."""

CORNERS = POLYTOPE_CORNERS | CURVED_CORNERS
"""Name, provenance, alpha, its pose, beta, its pose."""


def distance_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng = np.random.default_rng(22)
    kinds = list(SHAPES)
    for i, first in enumerate(kinds):
        for second in kinds[i:]:
            if first != "halfspace" or second != "halfspace":
                yield from _pair(rng, *((first, second) if rng.integers(2) else (second, first)))
    for kind, shape in SHAPES.items():
        points = cloud(mixed_points(shape, rng, 14))
        where = {"pose_alpha": random_pose(rng, 0.2), "pose_beta": random_pose(rng, 0.02)}
        sides = {"alpha": shape, "beta": points}
        if rng.integers(2):
            sides = {"alpha": points, "beta": shape}
        provenance = f"14 points in, on and around a {kind}, its centre and axis among them"
        yield f"distance/cloud/{kind}", provenance, sides | where
    for name, (provenance, alpha, pose_alpha, beta, pose_beta) in CORNERS.items():
        yield (
            f"distance/corner/{name}",
            provenance,
            {"alpha": alpha, "beta": beta, "pose_alpha": pose_alpha, "pose_beta": pose_beta},
        )


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


def _nearly_touching(case: Table) -> Table:
    found, _, _ = answer(case)
    pose = case["pose_beta"]
    shift = found["phi"][0] - CLOSE
    xyz = [round(x - shift * n, 13) for x, n in zip(pose["xyz"], found["n"][0], strict=True)]
    return case | {"pose_beta": pose | {"xyz": xyz}}
