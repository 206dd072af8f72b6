"""What was promised, with its limit, and what was measured."""

from collections.abc import Mapping
from typing import Any

from quasistatic_ref.lab.bench.solids import HAND

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

OVER_MUJOCO = 6.0
"""What an uncertified step of separate boxes may cost in steps of MuJoCo; or, where the bare solver
alone takes more than that, what it may cost in bare calls of that:"""
OVER_ITS_SOLVER = 2.0
PROVED_OVER_OFF = 4.0
"""What a proved step of these may cost in uncertified ones."""


def promises(tables: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Each promise that the tables speak of: what, measured, limit and whether it holds.

    A quick run measures too little to judge; there `holds` is None.
    """
    grasp = tables["grasp"]
    measured = [(what, grasp.get(key), limit) for what, key, limit in GRASP]
    for name, costs in tables.get("solids", {}).items():
        if name != HAND:
            solver_decides = costs.get("solver_over_mujoco", 0.0) > OVER_MUJOCO
            by_solver = f"{name}, step over the bare solver", costs["over_solver"]
            by_mujoco = f"{name}, step over MuJoCo's", costs.get("over_mujoco")
            measured += [
                (*by_solver, OVER_ITS_SOLVER) if solver_decides else (*by_mujoco, OVER_MUJOCO),
                (f"{name}, proved over not", costs["proved_over_off"], PROVED_OVER_OFF),
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
