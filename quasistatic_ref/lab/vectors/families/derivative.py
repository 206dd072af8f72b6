"""Inputs of the layer `derivative`: steps with q+ smooth, and constructed kinks."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.derivative_kinks import kink_cases
from quasistatic_ref.lab.vectors.families.derivative_pairs import pair_cases, pair_kinds, pressed
from quasistatic_ref.lab.vectors.families.derivative_squeezed import squeezed_cases
from quasistatic_ref.lab.vectors.families.mechanisms import few_digits
from quasistatic_ref.lab.vectors.families.random_scenes import random_scene
from quasistatic_ref.lab.vectors.families.step import step_cases
from quasistatic_ref.lab.vectors.families.step_scenes import ball_scene
from quasistatic_ref.lab.vectors.layers import layer

RANDOM = 110
"""Scenes at random that are drawn."""
WILD = 1e3
"""Largest entry of dq+/dq [-, rad/m] in a case."""


def derivative_cases() -> Iterator[Case]:
    """Id, provenance and input of each case; those that ask nothing are left out.

    Raises
    ------
    AssertionError
        If a constructed kink is none of its kind.
    """
    for name, why, table in kink_cases():
        kind = name.split("/")[2]
        if kinds_of(table) != {kind}:
            raise AssertionError(f"{name} is no kink of the kind {kind}: {kinds_of(table)}")
        yield name, why, table
    steps = [(name.replace("step/", "derivative/"), *rest) for name, *rest in step_cases()]
    for name, why, table in (*steps, *pair_cases(), *_at_random()):
        if kinds_of(table) == set():
            yield name, why, table


def kinds_of(table: Json) -> set[str] | None:
    """Kinds of the reasons why q+ has no derivative; None of a case that asks nothing."""
    try:
        output = layer("derivative").expected(table).output
        if output["differentiable"] and hangs_on_rounding(table):
            return None
    except (QuasistaticError, ArithmeticError, LookupError):
        return None
    if not is_tame(output):
        return None
    return {reason["kind"] for reason in output["reasons"]}


def hangs_on_rounding(table: Json) -> bool:
    """Whether float64 cannot tell which contacts are kept, or which points of them are closest."""
    flags = layer("step").expected(table).flags
    return flags["tie"] or not flags["unique"]


def derivative_at_random(rng: Rng, level: int) -> Json:
    """The input of a case: a ball on the floor, two shapes or a scene at random, or a kink.

    Parameters
    ----------
    rng : Rng
    level : int
        0 of easy cases, 1 of those as in the vectors, 2 of kinks and of larger scenes.
    """
    kind = int(rng.integers(3))
    if level == 0:
        spun = few_digits(rng.uniform(-0.5, 0.5, 3), 1)
        wrench = {"body": "ball", "force": [*spun[:2], -1.0], "torque": [0.0, 0.0, spun[2] / 10]}
        return ball_scene([0.0, 0.0, 0.05], wrenches=[wrench])
    if level == 2 and kind:
        kinks = [*kink_cases(), *squeezed_cases()]
        return kinks[int(rng.integers(len(kinks)))][2]
    if kind == 0:
        return random_scene(rng, hard=level == 2)
    pairs = pair_kinds()
    alpha, beta = pairs[int(rng.integers(len(pairs)))]
    moving = "beta" if alpha == "halfspace" else "alpha"
    return pressed(rng, alpha, beta, moving, driven=bool(rng.integers(2)))


def is_tame(output: Json) -> bool:
    """Whether float64 can answer a case: closest points that are next to nothing apart turn fast.

    Parameters
    ----------
    output : dict
    """
    entries = [abs(x) for row in output.get("dq_dq", []) for x in row]
    return max(entries, default=0.0) < WILD


def _at_random() -> Iterator[Case]:
    for number in range(RANDOM):
        rng = np.random.default_rng([19, 8, number])
        table = random_scene(rng, hard=number % 3 == 2)
        yield f"derivative/random/{number}", "a scene at random, of the layer step's family", table
