"""The families that a study makes for itself: which scene, and which number is scaled."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from quasistatic_ref.lab.study.problems.families.harvest import (
    Count,
    harvested,
    no_count,
    scenario_run,
    stepped_again,
)
from quasistatic_ref.lab.study.problems.families.made import Made
from quasistatic_ref.lab.study.problems.families.scaled import slabs, towers

AGAIN: Final = "bunny_grasp"
"""The scenario whose steps are formed again at other h and k: the paper's own."""
CLOSEST: Final = (1, 2, 3, 5, 8, 13, 20, 32, 50)
TIME_STEPS: Final = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
MOST: Final = {"contacts": 1000.0, "mass_ratio": 1e9, "bodies": 40.0}
"""Hard ends of the dials that a study file may end elsewhere."""
FAMILIES: Final = ("scenarios", "contacts", "mass_ratio", "time_step", "closest_points", "bodies")


def scenarios_run(families: Mapping[str, int], scenarios: Sequence[str]) -> list[str]:
    """The scenarios whose runs so many problems of each family are taken from."""
    found = list(scenarios[: families.get("scenarios", 0)])
    if families.get("time_step", 0) > 1 or families.get("closest_points", 0):
        found.append(AGAIN)
    return list(dict.fromkeys(found))


def drawn(
    family: str,
    count: int,
    seed: int,
    scenarios: Sequence[str],
    most: float | None = None,
    count_steps: Count = no_count,
) -> Iterator[Made]:
    """The steps of one family.

    Parameters
    ----------
    family : str
        One of ``FAMILIES``.
    count, seed : int
    scenarios : sequence of str
        Whose steps the family ``scenarios`` has.
    most : float, optional
        Where the dial ends [its unit]; else at its hard end.
    count_steps : callable
        Is called with the number of steps of scenarios that were just simulated.
    """
    for name in scenarios_run({family: count}, scenarios):
        scenario_run(name, count_steps)
    end = MOST.get(family, 0.0) if most is None else most
    if family == "scenarios":
        for name, share in zip(scenarios, _shares(count, len(scenarios)), strict=True):
            yield from harvested(name, share)
    elif family == "contacts":
        yield from slabs(family, "contacts", np.geomspace(1, end, count).round(), seed)
    elif family == "mass_ratio":
        yield from slabs(family, "ratio", np.geomspace(1, end, count), seed)
    elif family == "bodies":
        yield from towers([int(v) for v in np.geomspace(2, end, count).round()], seed)
    elif family == "time_step":
        steps = np.geomspace(TIME_STEPS[0], TIME_STEPS[-1], -(-count // 2))
        yield from slabs(family, "h", steps, seed)
        shares = _shares(count // 2, len(TIME_STEPS))
        for i, (h, share) in enumerate(zip(TIME_STEPS, shares, strict=True)):
            for one in stepped_again(family, AGAIN, [f"h={h}"], share, i):
                yield replace(one, dial=one.step.h)
    else:
        for i, (k, share) in enumerate(zip(CLOSEST, _shares(count, len(CLOSEST)), strict=True)):
            changes = [f"contacts.grip.k={k}", f"contacts.floor.k={k}"]
            for one in stepped_again(family, AGAIN, changes, share, i):
                yield replace(one, dial=float(one.k))


def _shares(count: int, parts: int) -> list[int]:
    return [count // parts + (i < count % parts) for i in range(parts)]
