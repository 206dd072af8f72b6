"""Inputs of the layer `integrate`: twists of every size, about every kind of joint."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case, by_hand
from quasistatic_ref.lab.vectors.families.mechanisms import (
    follower,
    free_body,
    gripper,
    link,
    random_q,
    random_step,
    random_tree,
)


def integrate_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng, written = np.random.default_rng(21), by_hand("integrate")
    free = {"bodies": [free_body()]}
    start = [0.1, -0.2, 0.3, 0.5, -0.5, 0.5, 0.5]
    for name, angle in written["angles"].items():
        about_z = [0.02, -0.01, 0.03, 0.0, 0.0, angle]
        why = f"a free body's twist about its own z by {angle!r} rad"
        yield f"integrate/screw/{name}", why, {"mechanism": free, "q": start, "delta_q": about_z}
    for name in ("tiny", "small", "nearly_pi", "nearly_two_pi"):
        angle, axis = written["angles"][name], np.array([2.0, -3.0, 6.0]) / 7
        twist = [0.02, -0.01, 0.03, *(axis * angle).tolist()]
        why = f"the same about a skew axis, {angle!r} rad"
        yield f"integrate/skew/{name}", why, {"mechanism": free, "q": start, "delta_q": twist}
    for name, step in written["free"].items():
        why = f"a free body, {name.replace('_', ' ')}"
        yield f"integrate/free/{name}", why, {"mechanism": free, **step}
    for name, step in written["single"].items():
        kind = step.pop("joint")
        tree = {"bodies": [link("body", None, kind, actuated=True)]}
        why = f"one joint: {name.replace('_', ' ')}"
        yield f"integrate/{kind}/{name}", why, {"mechanism": tree, **step}
    for number in range(9):
        base, count = ("fixed", "floating", "planar")[number % 3], 3 + number // 3
        why = f"a random tree of {count} bodies on a {base} base"
        name = f"integrate/tree/{base}/{number // 3}"
        yield name, why, step_at_random(rng, random_tree(rng, count, base))
    for number, size in enumerate((1e-2, 1e-4, 1e-7)):
        tree = {"bodies": [free_body(), *gripper()["bodies"]]}
        why = f"a gripper and a body, a step of about {size:g}: actuated coordinates come first"
        yield f"integrate/grasp/{number}", why, step_at_random(rng, tree, size)
    stand = link("stand", None, "fixed")
    tree = {"bodies": [free_body(), stand, *follower("revolute", "stand", actuated=True)]}
    why = "a joint that follows another has no entry of q"
    yield "integrate/mimic", why, step_at_random(rng, tree)


def step_at_random(rng: Rng, tree: Json, size: float = 0.5) -> Json:
    """A step of about the `size` [m, rad], from a random configuration."""
    q = random_q(rng, tree)
    return {"mechanism": tree, "q": q, "delta_q": random_step(rng, tree, size)}
