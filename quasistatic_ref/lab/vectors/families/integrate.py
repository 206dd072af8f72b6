"""Inputs of the layer `integrate`: twists of every size, about every kind of joint."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.vectors.families.mechanisms import (
    free_body,
    gripper,
    link,
    random_q,
    random_step,
    random_tree,
)
from quasistatic_ref.lab.vectors.families.shapes import Table

Case = tuple[str, str, Table]

ANGLES = {
    "tiny": 1e-9,
    "below_rounding": 1e-17,
    "subnormal_square": 1e-160,
    "small": 1e-4,
    "quarter": 1.5707963267948966,
    "nearly_pi": 3.1415926,
    "pi": 3.141592653589793,
    "beyond_pi": 3.3,
    "nearly_two_pi": 6.283185307179586,
    "many_turns": 50.0,
}
"""[rad]. A step of the simulator turns by 1e-9 to 1e-2."""


def integrate_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng = np.random.default_rng(21)
    free = {"bodies": [free_body()]}
    start = [0.1, -0.2, 0.3, 0.5, -0.5, 0.5, 0.5]
    for name, angle in ANGLES.items():
        about_z = [0.02, -0.01, 0.03, 0.0, 0.0, angle]
        yield (
            f"integrate/screw/{name}",
            f"a free body's twist about its own z by {angle!r} rad",
            {"mechanism": free, "q": start, "delta_q": about_z},
        )
    for name in ("tiny", "small", "nearly_pi", "nearly_two_pi"):
        axis = np.array([2.0, -3.0, 6.0]) / 7
        twist = [0.02, -0.01, 0.03, *(axis * ANGLES[name]).tolist()]
        yield (
            f"integrate/skew/{name}",
            f"the same about a skew axis, {ANGLES[name]!r} rad",
            {"mechanism": free, "q": start, "delta_q": twist},
        )
    for name, q, step in (
        ("zero", start, [0.0] * 6),
        ("translation", start, [0.25, -0.5, 1.0, 0.0, 0.0, 0.0]),
        ("rotation", start, [0.0, 0.0, 0.0, 0.3, -0.2, 0.1]),
        ("unnormalised", [0.1, -0.2, 0.3, 1.0, 2.0, -3.0, 4.0], [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]),
        (
            "short_quaternion",
            [0.0, 0.0, 0.0, 1e-3, 2e-3, 0.0, 1e-3],
            [0.0, 0.1, 0.0, 0.2, 0.0, 0.0],
        ),
        ("negative_w", [0.0, 0.0, 0.0, 0.5, 0.5, 0.5, -0.5], [0.1, 0.0, 0.0, 0.0, 0.2, 0.0]),
        ("to_zero_w", [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1e-8, 0.0, 0.0]),
        ("far", [1e4, -2e4, 3e4, 0.1, 0.2, 0.3, 0.9], [1e-3, 2e-3, 3e-3, 1e-3, 1e-3, 1e-3]),
        ("zero_unnormalised", [0.0, 0.0, 0.0, 0.1, 0.2, 0.3, 0.4], [0.0] * 6),
    ):
        yield (
            f"integrate/free/{name}",
            f"a free body, {name.replace('_', ' ')}",
            {"mechanism": free, "q": q, "delta_q": step},
        )
    yield from _single_joints()
    for number in range(9):
        base = ("fixed", "floating", "planar")[number % 3]
        tree = random_tree(rng, 3 + number // 3, base)
        yield (
            f"integrate/tree/{base}/{number // 3}",
            f"a random tree of {3 + number // 3} bodies on a {base} base",
            {"mechanism": tree, "q": random_q(rng, tree), "delta_q": random_step(rng, tree)},
        )
    for number in range(3):
        tree = {"bodies": [free_body(), *gripper()["bodies"]]}
        size = (1e-2, 1e-4, 1e-7)[number]
        yield (
            f"integrate/grasp/{number}",
            f"a gripper and a body, a step of about {size:g}: actuated coordinates come first",
            {"mechanism": tree, "q": random_q(rng, tree), "delta_q": random_step(rng, tree, size)},
        )


def _single_joints() -> Iterator[Case]:
    for name, kind, q, step in (
        ("revolute", "revolute", [0.7], [0.1]),
        ("revolute_past_pi", "revolute", [3.1], [0.2]),
        ("prismatic", "prismatic", [0.1], [0.2]),
        ("prismatic_tie", "prismatic", [1.0], [2.0**-53]),
        ("prismatic_above_tie", "prismatic", [1.0 + 2.0**-52], [2.0**-53]),
        ("continuous", "continuous", [0.6, 0.8], [0.1]),
        ("continuous_zero", "continuous", [0.6, -0.8], [0.0]),
        ("continuous_unnormalised", "continuous", [1.0, 1.0], [-0.3]),
        ("continuous_pi", "continuous", [-1.0, 0.0], [3.141592653589793]),
        ("continuous_tiny", "continuous", [1.0, 0.0], [1e-17]),
        ("planar", "planar", [0.1, 0.2, 0.6, 0.8], [0.1, -0.2, 0.5]),
        ("planar_zero", "planar", [0.1, 0.2, 0.8, -0.6], [0.0, 0.0, 0.0]),
        ("planar_translation", "planar", [0.1, 0.2, 0.0, 1.0], [0.5, 0.25, 0.0]),
        ("planar_tiny", "planar", [0.1, 0.2, 1.0, 0.0], [0.1, 0.2, 1e-10]),
        ("planar_pi", "planar", [0.0, 0.0, 1.0, 0.0], [0.1, 0.2, 3.141592653589793]),
        ("planar_unnormalised", "planar", [1.0, -1.0, 3.0, 1.0], [0.1, 0.2, -0.4]),
    ):
        tree = {"bodies": [link("body", None, kind, actuated=True)]}
        yield (
            f"integrate/{kind}/{name}",
            f"one joint: {name.replace('_', ' ')}",
            {"mechanism": tree, "q": q, "delta_q": step},
        )
