"""What was promised, with its limit, and what was measured."""

from collections.abc import Mapping
from typing import Any

from quasistatic_ref.lab.study.bench.solids import HAND

PAPER = 90.0
"""The paper's step takes less than this: Julia 1.9.2 on a Mac M1 Pro, all distances, its own
interior-point method, at an accuracy that it does not give [us]."""

OVER_SOLVER = 16.0
"""What a step without a compiler may cost in bare calls of DAQP, of 22 to 27 us each where the two
take turns. A step is some 420 calls of about a microsecond each, whatever they compute; with fewer,
its lines would not read as the equations."""

THROUGH_CVXPY = 8.0 * 12.0 / OVER_SOLVER
"""What a step through CVXPY may at least cost in native steps. It was 8 while a native step might
cost 12 bare calls; native steps may cost more since, and those through CVXPY may not."""

BOUNDED = 1.5
"""What a step with residuals and a bound of its error may cost in steps that claim nothing; both
by NumPy."""

COMPILED = (
    ("compiled step over the bare solver", "over_solver", 4.0),
    ("compiled step [us]", "step", PAPER),
    ("compiled step, certified [us]", "certified", 250.0),
    ("compiled step, certified, 99th percentile [us]", "certified, p99", 350.0),
)
"""What, its name in the table, and the limit."""

OVER_MUJOCO = 6.0
"""What an uncertified step of separate boxes may cost in steps of MuJoCo; or, where the bare solver
alone takes more than that, what it may cost in bare calls of that:"""
OVER_ITS_SOLVER = 2.0
PROVED_OVER_OFF = 4.0
"""What a proved step of these may cost in uncertified ones."""

AT_MOST = "at most"
AT_LEAST = "at least"


def promises(tables: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Each promise that the tables speak of: what, measured, limit and whether it holds.

    A quick run measures too little to judge; there `holds` is None.
    """
    interfaces = tables["interfaces"]
    measured = [
        ("step over the bare solver", interfaces["over_solver"], AT_MOST, OVER_SOLVER),
        ("through CVXPY over native", interfaces["cvxpy_over_native"], AT_LEAST, THROUGH_CVXPY),
        ("bounded step over the same without", tables.get("residual_over_off"), AT_MOST, BOUNDED),
    ]
    compiled = tables.get("compiled") or {}
    measured += [(what, compiled.get(key), AT_MOST, limit) for what, key, limit in COMPILED]
    for name, costs in tables.get("solids", {}).items():
        if name != HAND:
            solver_decides = costs.get("solver_over_mujoco", 0.0) > OVER_MUJOCO
            by_solver = f"{name}, step over the bare solver", costs["over_solver"]
            by_mujoco = f"{name}, step over MuJoCo's", costs.get("over_mujoco")
            measured += [
                (*by_solver, AT_MOST, OVER_ITS_SOLVER)
                if solver_decides
                else (*by_mujoco, AT_MOST, OVER_MUJOCO),
                (f"{name}, proved over not", costs["proved_over_off"], AT_MOST, PROVED_OVER_OFF),
            ]
    judged = not tables["quick"]
    return [
        {
            "what": what,
            "measured": value,
            "limit": limit,
            "sense": sense,
            "holds": _kept(value, sense, limit) if judged else None,
        }
        for what, value, sense, limit in measured
        if value is not None
    ]


def _kept(value: float, sense: str, limit: float) -> bool:
    return bool(value <= limit if sense == AT_MOST else value >= limit)
