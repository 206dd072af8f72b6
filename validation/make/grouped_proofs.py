"""What exact proofs of many bodies cost: ``python -m validation.make.grouped_proofs > FILE``.

Processor time and memory of certified steps of boxes that do not touch each other, each a group of
its own, and of boxes that do; next to that with ``certify = "residual"``. Each scene is measured in
a process of its own. Random steps and the steps of scenarios have the same bits whether they are
proved whole or by group. Takes some minutes. Exit status 1 if a promise does not hold.
"""

from __future__ import annotations

import argparse
import multiprocessing
import resource
import sys
import time
from collections import Counter
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import exact_optimum, exact_step
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.errors import StepIllPosed, StepInfeasible
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.scenes.at_random import divided
from quasistatic_ref.lab.scenes.piles import SIDE, pile
from quasistatic_ref.lab.study.measuring.environment import machine
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.groups import groups
from tests.oracles.random_steps import mixed_step
from validation.make.large_steps import print_table

SAME = (
    "delta_q",
    "net",
    "slack",
    "multipliers_unique",
    "differentiable",
    "smallest_inactive_slack",
)
"""What of an optimum no choice is left of."""

STEPS = 3
"""Measured after the first, which forms what the others keep."""

AT_MOST = 5.0
"""Time of 40 separate boxes over that of 10."""

SECONDS = 10.0
"""Of a certified step of 1,000 separate boxes [s]."""


class Scene(NamedTuple):
    """Boxes, next to and on each other.

    Parameters
    ----------
    name : str
    shape : (int, int, int)
    gap : float
        Between neighbours [m]; from a side on nothing touches.
    yaw : float
        Largest turn of a box about the vertical [rad].
    pushed : bool
        Whether the first is.
    """

    name: str
    shape: tuple[int, int, int]
    gap: float = 1e-4
    yaw: float = 0.0
    pushed: bool = False


SEPARATE = [
    Scene(f"{n:,} separate boxes, {how}", (n, 1, 1), SIDE, yaw)
    for n in (10, 40, 200, 1000)
    for how, yaw in (("aligned", 0.0), ("yawed", 1.5))
]
CONNECTED = [
    Scene("12 boxes in a row, pushed", (12, 1, 1), pushed=True),
    Scene("12 yawed boxes in a row, pushed", (12, 1, 1), 0.004, 0.1, True),
    Scene("25 yawed boxes in a row, pushed", (25, 1, 1), 0.004, 0.1, True),
    Scene("a stack of 40", (1, 1, 40)),
    Scene("a heap of 3 x 3 x 3, pushed", (3, 3, 3), pushed=True),
    Scene("a heap of 5 x 5 x 4, pushed", (5, 5, 4), pushed=True),
]


@dataclass(frozen=True)
class Cost:
    """What a step of a scene costs.

    Parameters
    ----------
    contacts, coordinates, groups : int
    first, later : float
        Processor time of the first step, and the median of some later ones [s].
    memory : float
        Peak of the process [MB].
    exact : int
        How many of these steps are certified exactly.
    """

    contacts: int
    coordinates: int
    groups: int
    first: float
    later: float
    memory: float
    exact: int


def cost(scene: Scene, certify: str) -> Cost:
    """What the steps of a scene cost, with `fast` and the backend that it takes by itself."""
    some = pile(scene.shape, backend=None, certify=certify, gap=scene.gap, yaw=scene.yaw)
    q, times, exact = some.q, [], 0
    for _ in range(1 + STEPS):
        begin = time.process_time()
        result = some.simulator.step(q, np.zeros(0), float(scene.pushed) * some.force)
        times.append(time.process_time() - begin)
        exact += result.solution.certificate.kind == "exact"
        q = result.q
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    step = result.step
    later = float(np.median(times[1:]))
    return Cost(some.contacts, step.n_v, len(groups(step)), times[0], later, peak, exact)


def alone(scene: Scene, certify: str) -> Cost:
    """The same in a process of its own, for its memory."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(cost, (scene, certify))


def table(scenes: list[Scene]) -> dict[str, Cost]:
    """Print what some scenes cost; by their names."""
    head = "scene, contacts, coordinates, groups, first [s], later [s], residual [s], ratio, "
    head += "memory [MB], of it with residual [MB], exact"
    rows, found = [head.split(", ")], {}
    for scene in scenes:
        full, said = alone(scene, "full"), alone(scene, "residual")
        found[scene.name] = full
        rows.append(
            [scene.name, f"{full.contacts:,}", f"{full.coordinates:,}", f"{full.groups:,}"]
            + [f"{s:.3g}" for s in (full.first, full.later, said.later)]
            + [f"{full.later / said.later:.1f}", f"{full.memory:.0f}", f"{said.memory:.0f}"]
            + [f"{full.exact} of {1 + STEPS}"]
        )
    print_table(rows)
    return found


def random_case(seed: int) -> StepData:
    """A random step, mostly without what couples two or three classes of its coordinates."""
    rng = np.random.default_rng([seed, 3])
    return divided(rng, mixed_step(seed), int(rng.integers(1, 4)))


def faults(step: StepData) -> list[str]:
    """In what the optimum by group is not that of the whole; empty if it is."""
    whole = exact_optimum(exact_form(step))
    try:
        grouped = exact_step(step)
    except StepInfeasible as failure:
        if not isinstance(whole, Farkas):
            return ["infeasible by group only"]
        reason = farkas_refutation(step, failure.farkas.exact)
        return [] if reason is None else [reason]
    except StepIllPosed as failure:
        if isinstance(whole, Farkas):
            return ["feasible by group only"]
        return [] if failure.delta_q.tobytes() == whole.delta_q.tobytes() else ["delta_q"]
    if isinstance(whole, Farkas):
        return ["feasible by group only"]
    names = (*SAME, "lam") if whole.multipliers_unique else SAME
    return [name for name in names if _bits(getattr(whole, name)) != _bits(getattr(grouped, name))]


def _bits(value: object) -> object:
    return value.tobytes() if isinstance(value, np.ndarray) else value


def compared(random: int, every: int) -> list[str]:
    """Print on how many steps whole and groups were compared; what differs, in words."""
    found, wrong = Counter[str](), []
    for seed in range(random):
        step = random_case(seed)
        found[f"random steps of {len(groups(step))} groups"] += 1
        wrong += [f"random step {seed}: {fault}" for fault in faults(step)]
    for name in scenario_names():
        run = load_scenario(name, fast=True).run(progress=False)
        for k in range(0, run.steps, every):
            found[f"steps of {name}"] += 1
            wrong += [f"{name}, step {k}: {fault}" for fault in faults(run.step_data(k))]
    print_table([["steps", "compared"], *([what, str(n)] for what, n in sorted(found.items()))])
    return wrong


def main() -> int:
    """Measure, compare, and print the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--random", type=int, default=1000, metavar="STEPS")
    parser.add_argument("--every", type=int, default=10, metavar="N", help="of a scenario's steps")
    options = parser.parse_args()
    m = machine()
    print("# Proofs by group, and of connected scenes")
    print(
        f"\nWritten by `python -m validation.make.grouped_proofs` on {m['processor']}, "
        f"{m['cores']} cores, Python {m['python']}: processor time of a step with `fast`, the "
        f"median of {STEPS} after the first, and the peak memory of its process. Four contacts a "
        "pair, six rows a contact."
    )
    print("\n## Boxes that do not touch each other\n")
    found = table(SEPARATE)
    print("\n## Boxes that do\n")
    table(CONNECTED)
    print("\n## The same bits\n")
    print("`delta_q`, `A'lam`, slacks and what is said of them, by group and of the whole step:\n")
    wrong = compared(options.random, options.every)
    print("\n## Promises\n")
    measured = []
    for how in ("aligned", "yawed"):
        few, many, most = (found[f"{n} separate boxes, {how}"] for n in ("10", "40", "1,000"))
        measured.append((f"40 boxes over 10, {how}", many.later / few.later, AT_MOST))
        measured.append((f"1,000 boxes, {how} [s]", most.later, SECONDS))
    measured.append(("steps whose bits differ", float(len(wrong)), 0.0))
    rows = [["promise", "measured", "at most", "verdict"]]
    rows += [[w, f"{v:.3g}", f"{at:g}", "holds" if v <= at else "FAILS"] for w, v, at in measured]
    print_table(rows)
    print(*wrong, sep="\n", file=sys.stderr)
    return int(any(value > limit for _, value, limit in measured))


if __name__ == "__main__":
    sys.exit(main())
