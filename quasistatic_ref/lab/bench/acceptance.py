"""What was promised, with its limit, and what was measured."""

from collections.abc import Mapping
from typing import Any

from quasistatic_ref.lab.bench.solids import STATES

PAPER = 90.0
"""The paper's step takes less than this: Julia 1.9.2 on a Mac M1 Pro, all distances, its own
interior-point method, at an accuracy that it does not give [us]."""

GRASP = (
    ("step of the grasp over the bare solver", "over_solver", 4.0),
    ("step of the grasp [us]", "step", PAPER),
    ("step of the grasp, certified [us]", "certified", 250.0),
    ("step of the grasp, certified, 99th percentile [us]", "certified, p99", 350.0),
)
"""What, its name in the table, and the limit."""

PROVED_OVER_OFF = 4.0
"""What a proved step of solids may cost in uncertified ones."""
FIRST_OVER_LATER = 10.0
"""What a proved first step may cost in later ones."""
OVER_MUJOCO = 6.0
"""What an uncertified step of single cubes may cost in steps of MuJoCo; or, where the bare solver
alone takes more than that, what it may cost in bare calls of that:"""
OVER_ITS_SOLVER = 2.0

GROWTH = (
    ("40 cubes, askew", "10 cubes, askew", 4.5),
    ("100 cubes, askew", "40 cubes, askew", 3.0),
    ("200 cubes, askew", "40 cubes, askew", 6.0),
    ("40 stacks of five, rest", "8 stacks of five, rest", 8.0),
)
"""A proved step of which scene may cost how many times that of which."""


def promises(tables: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Each promise that the tables speak of: what, measured, limit and whether it holds.

    A quick run measures too little to judge; there `holds` is None.
    """
    grasp = tables["grasp"]
    measured = [(what, grasp.get(key), limit) for what, key, limit in GRASP]
    solids = tables.get("solids", {})
    large = tables.get("large", {})
    every = solids | large
    by_solver = {
        name: costs["over_solver"]
        for name, costs in solids.items()
        if name in STATES and costs.get("solver_over_mujoco", 0.0) > OVER_MUJOCO
    }
    by_mujoco = {
        name: costs["over_mujoco"]
        for name, costs in solids.items()
        if name in STATES and name not in by_solver and "over_mujoco" in costs
    }
    of_scenes = (
        ("proved step over one that is not", _each(every, "proved_over_off"), PROVED_OVER_OFF),
        ("first step over later ones", _each(every, "first_over_later"), FIRST_OVER_LATER),
        ("step of single cubes over MuJoCo's", by_mujoco, OVER_MUJOCO),
        ("step of single cubes over the bare solver", by_solver, OVER_ITS_SOLVER),
    )
    measured += [_most(what, each, limit) for what, each, limit in of_scenes if each]
    measured += [
        (f"{many} over {few}", large[many]["full"] / large[few]["full"], limit)
        for many, few, limit in GROWTH
        if many in large and few in large
    ]
    judged = not tables["quick"]
    return [
        {
            "what": what,
            "measured": value,
            "limit": limit,
            "holds": bool(value <= limit) if judged else None,
        }
        for what, value, limit in measured
        if value is not None
    ]


def _each(scenes: Mapping[str, Mapping[str, float]], ratio: str) -> dict[str, float]:
    """A ratio of each scene."""
    return {name: costs[ratio] for name, costs in scenes.items()}


def _most(what: str, each: Mapping[str, float], limit: float) -> tuple[str, float, float]:
    """The largest of what was measured in some scenes: in which, and in how many beyond a limit."""
    name = max(each, key=lambda name: each[name])
    beyond = sum(value > limit for value in each.values())
    return f"{what}, most of {len(each)} scenes, {beyond} beyond: {name}", each[name], limit
