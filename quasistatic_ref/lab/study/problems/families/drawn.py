"""The steps of each family: which scene, which scenario, and which number is turned."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from quasistatic_ref.lab.scenes.slabs import slab_step
from quasistatic_ref.lab.study.problems.families.dials import DIALS, HARVESTED, turned
from quasistatic_ref.lab.study.problems.families.harvest import (
    Count,
    harvested,
    no_count,
    scenario_run,
    stepped_again,
)
from quasistatic_ref.lab.study.problems.families.made import Made
from quasistatic_ref.lab.study.problems.families.windows import windows

AGAIN: Final = "bunny_grasp"
"""The scenario whose steps are formed again at other h and k: the paper's own."""
CLOSEST: Final = (1, 2, 3, 5, 8, 13, 20, 32, 50)
TIME_STEPS: Final = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
OF_SETS: Final = ("sequences", "ellipsoid", "sparse")
"""Families of which a study makes no problems: whole runs, cones, and sparse matrices."""
FAMILIES: Final = tuple(name for name in (*HARVESTED, *DIALS) if name not in OF_SETS)
"""Families that a study may make."""


def scenarios_run(families: Mapping[str, int], scenarios: Sequence[str]) -> list[str]:
    """The scenarios whose runs so many problems of each family are taken from."""
    found = list(scenarios[: families.get("scenarios", 0)])
    if families.get("time_step", 0) > 1 or families.get("closest_points", 0):
        found.append(AGAIN)
    return list(dict.fromkeys(found))


def family_steps(
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
    count, seed : int
        ``sequences`` takes whole windows of every scenario.
    scenarios : sequence of str
        Whose steps the families ``scenarios`` and ``sequences`` have.
    most : float, optional
        Where the dial of a scene ends [its unit]; else at its hard end.
    count_steps : callable
        Is called with the number of steps of scenarios that were just simulated.
    """
    if family in DIALS:
        yield from turned(family, count, seed, most)
        return
    for name in scenarios_run({family: count}, scenarios):
        scenario_run(name, count_steps)
    if family == "sequences":
        for name in scenarios:
            yield from windows(name, count=count_steps)
    elif family == "scenarios":
        for name, share in zip(scenarios, _shares(count, len(scenarios)), strict=True):
            yield from harvested(name, share)
    elif family == "time_step":
        for i, h in enumerate(np.geomspace(TIME_STEPS[0], TIME_STEPS[-1], -(-count // 2))):
            step = slab_step(np.random.default_rng([seed, i, 1]), 12, 10.0, float(h))
            yield Made(f"{family}/{h:.6g}/{i}", family, step, 10.0, 0, float(h))
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
