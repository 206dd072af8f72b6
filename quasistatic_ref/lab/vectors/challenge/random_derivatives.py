"""Inputs of the layer `derivative` at random: steps with q+ smooth, and kinks."""

from functools import cache

from quasistatic_ref.lab.folders import vectors_folder
from quasistatic_ref.lab.scenes.at_random import Rng
from quasistatic_ref.lab.vectors.challenge.random_mechanisms import few_digits
from quasistatic_ref.lab.vectors.challenge.random_scenes import random_scene
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.files import Case, inputs_read
from quasistatic_ref.lab.vectors.layers import layer
from quasistatic_ref.lab.vectors.tables import FLOOR, UPRIGHT, link, on, scene

WILD = 1e3
"""Largest entry of dq+/dq [-, rad/m] in a case."""
BALL: Json = {"kind": "sphere", "radius": 0.05}
MASS: Json = {
    "mass": 0.5,
    "com": [0.0, 0.0, 0.0],
    "inertia": [[0.001, 0.0, 0.0], [0.0, 0.0012, 0.0], [0.0, 0.0, 0.0014]],
}


def hangs_on_rounding(table: Json) -> bool:
    """Whether float64 cannot tell which contacts are kept, or which points of them are closest."""
    flags = layer("step").expected(table).flags
    return flags["tie"] or not flags["unique"]


def derivative_at_random(rng: Rng, level: int) -> Json:
    """The input of a case: a ball on the floor, a scene at random, a case of the vectors or a kink.

    Parameters
    ----------
    rng : Rng
    level : int
        0 of easy cases, 1 of those as in the vectors, 2 of kinks and of larger scenes.
    """
    kind = int(rng.integers(3))
    if level == 0:
        spun = few_digits(rng.uniform(-0.5, 0.5, 3), 1)
        return ball_scene({"force": [*spun[:2], -1.0], "torque": [0.0, 0.0, spun[2] / 10]})
    if kind == 0:
        return random_scene(rng, hard=level == 2)
    wanted = "derivative/kink/" if level == 2 else "derivative/pair/"
    chosen = [case.input for case in _committed_cases() if case.id.startswith(wanted)]
    case: Json = chosen[int(rng.integers(len(chosen)))]
    return case if level == 2 else _varied(rng, case)


@cache
def _committed_cases() -> list[Case]:
    """The cases among the vectors that come along."""
    return inputs_read(vectors_folder(), "derivative")


def _varied(rng: Rng, case: Json) -> Json:
    """Two shapes of any kinds in the same place, which are pressed and rub otherwise."""
    pairs = [
        {**pair, "mu_v": few_digits(rng.uniform(0.1, 1.0, 1))[0],
         "mu_omega": few_digits(rng.uniform(0.001, 0.02, 1))[0], "rows": int(rng.choice([4, 6]))}
        for pair in case["pairs"]
    ]  # fmt: skip
    wrenches = [
        {**wrench, "force": few_digits(rng.uniform(0.5, 1.5, 3) * wrench["force"]),
         "torque": few_digits(rng.uniform(-1, 1, 3) * wrench["torque"], 4)}
        for wrench in case["wrenches"]
    ]  # fmt: skip
    cone = str(rng.choice(["pyramid", "pyramid", "pyramid", "product", "facets-6"]))
    return {**case, "pairs": pairs, "wrenches": wrenches, "cone": cone}


def is_tame(output: Json) -> bool:
    """Whether float64 can answer a case: closest points that are next to nothing apart turn fast.

    Parameters
    ----------
    output : dict
    """
    entries = [abs(x) for row in output.get("dq_dq", []) for x in row]
    return max(entries, default=0.0) < WILD


def ball_scene(wrench: Json) -> Json:
    """A ball on a floor, and a wrench on it."""
    ball = link("ball", None, "floating", **MASS)
    shapes = {"floor": on(None, FLOOR), "ball": on("ball", BALL)}
    friction = {"mu_v": 0.5, "mu_omega": 0.01, "rows": 6}
    pair = {"name": "floor", "alpha": "floor", "beta": "ball", **friction, "k": 1}
    q = [0.0, 0.0, 0.05, *UPRIGHT]
    return scene([ball], shapes, q, pairs=[pair], wrenches=[{"body": "ball", **wrench}])
