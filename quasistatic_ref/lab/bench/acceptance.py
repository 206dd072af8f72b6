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
    for name, costs in (solids | large).items():
        measured += [
            (f"{name}: proved over not", costs["proved_over_off"], PROVED_OVER_OFF),
            (f"{name}: first over later", costs["first_over_later"], FIRST_OVER_LATER),
        ]
        if name in STATES:
            solver_decides = costs.get("solver_over_mujoco", 0.0) > OVER_MUJOCO
            by_solver = f"{name}: step over the bare solver", costs["over_solver"]
            by_mujoco = f"{name}: step over MuJoCo's", costs.get("over_mujoco")
            limit = OVER_ITS_SOLVER if solver_decides else OVER_MUJOCO
            measured.append((*(by_solver if solver_decides else by_mujoco), limit))
    measured += [
        (f"{many} over {few}", large[many]["full"] / large[few]["full"], limit)
        for many, few, limit in GROWTH
        if many in large
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
