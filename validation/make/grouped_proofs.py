"""What exact proofs of many bodies cost: ``python -m validation.make.grouped_proofs --out FILE``.

Processor time and memory of certified steps of boxes that do not touch each other, each a group of
its own, and of boxes that do; next to that with ``certify = "residual"``. Each scene is measured in
a process of its own. Random steps and the steps of scenarios have the same bits whether they are
proved whole or by group (``--random`` of the first, ``--every`` so manyth of the others). Takes
some minutes. Exit status 1 if a promise does not hold.
"""

import math
import multiprocessing
import os
import resource
import sys
import time
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.active_set import Farkas
from quasistatic_ref.certify.exact import ExactOptimum, form_optimum, step_optimum
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.errors import StepIllPosed, StepInfeasible
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.scenes.at_random import divided
from quasistatic_ref.lab.scenes.piles import SIDE, Pile, pile
from quasistatic_ref.lab.study.measuring.environment import machine
from quasistatic_ref.optional.fast.backends import DEFAULT_OF_LARGE
from quasistatic_ref.optional.fast.posed import constants, posed
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.groups import groups
from tests.oracles.random_steps import mixed_step
from validation.make.large_steps import promises
from validation.tools.scripts import asked, shown

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

HEAP = 5.0
"""Of a certified step of the heap of 1,040 contacts [s]."""

OVER_RESIDUAL = 10.0
"""Time of a certified step of about 100 contacts (``HUNDRED``) over that with ``residual``."""
HUNDRED = range(90, 111)


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
    before : int
        Steps of which nothing is certified, before those that are measured.
    copies : int
        If more than one, so many copies of the bodies, far from each other, as one step that is
        solved again and again: to make a system of them would take minutes.
    """

    name: str
    shape: tuple[int, int, int]
    gap: float = 1e-4
    yaw: float = 0.0
    pushed: bool = False
    before: int = 0
    copies: int = 1


SEPARATE = [
    Scene(f"{n:,} separate boxes, {how}", (n, 1, 1), SIDE, yaw)
    for n in (10, 40)
    for how, yaw in (("aligned", 0.0), ("yawed", 1.5))
]
COPIED = [
    Scene(f"1,000 separate boxes, {how}", (40, 1, 1), SIDE, yaw, copies=25)
    for how, yaw in (("aligned", 0.0), ("yawed", 1.5))
]
CONNECTED = [
    Scene("12 yawed boxes in a row, pushed", (12, 1, 1), 0.004, 0.1, True),
    Scene("25 yawed boxes in a row, pushed", (25, 1, 1), 0.004, 0.1, True),
    Scene("12 boxes in a row, after 60 steps", (12, 1, 1), pushed=True, before=60),
    Scene("25 boxes in a row, after 60 steps", (25, 1, 1), pushed=True, before=60),
    Scene("25 boxes in a row, after 200 steps", (25, 1, 1), pushed=True, before=200),
    Scene("a stack of 40, falling", (1, 1, 40)),
    Scene("a stack of 10 at rest", (1, 1, 10), before=150),
    Scene("a stack of 25 at rest", (1, 1, 25), before=450),
    Scene("a stack of 40 at rest", (1, 1, 40), before=450),
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
    over_residual : float
        ``later`` over the same with ``certify = "residual"``.
    """

    contacts: int
    coordinates: int
    groups: int
    first: float
    later: float
    memory: float
    exact: int
    over_residual: float = math.nan


def cost(scene: Scene, certify: str) -> Cost:
    """What the steps of a scene cost, with `fast` and the backend that it takes by itself."""
    some = _pile(scene, certify)
    free = None
    q = some.q
    times = []
    exact = 0
    force = float(scene.pushed) * some.force
    for _ in range(scene.before):
        free = free or _pile(scene, "off").simulator
        q = free.step(q, np.zeros(0), force).q
    step = some.simulator.step(q, np.zeros(0), force).step
    copied = copies(step, scene.copies) if scene.copies > 1 else None
    solver = None if copied is None else solver_for(copied, DEFAULT_OF_LARGE, fast=True)
    for _ in range(1 + STEPS):
        begin = time.process_time()
        if copied is None:
            result = some.simulator.step(q, np.zeros(0), force)
            q = result.q
            solution = result.solution
        else:
            solution = solve_step(copied, solver, certify=certify)
        times.append(time.process_time() - begin)
        exact += solution.certificate.kind == "exact"
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    step = solution.step
    later = float(np.median(times[1:]))
    sizes = step.contacts.n_c, step.n_v, len(groups(step))
    return Cost(*sizes, times[0], later, peak, exact)


def copies(step: StepData, times: int) -> StepData:
    """A step of free bodies, several times next to itself, its contacts in blocks."""
    c = step.contacts
    n_v = step.n_v
    of = np.repeat(np.arange(times), c.n_c)
    first = np.tile(np.arange(c.n_c), times)
    moves = (c.J != 0).any(axis=1)
    width = int(moves.sum(axis=1).max())
    column = np.argsort(~moves, axis=1, kind="stable")[:, :width]
    J = np.take_along_axis(c.J, column[:, None], axis=2)
    blocks = Blocks(np.sort(column, axis=1)[first] + n_v * of[:, None], J[first], n_v * times)
    contacts = SparseContacts(
        tuple(f"{i}/{c.name[j]}" for i, j in zip(of, first, strict=True)),
        *(given[first] for given in (c.phi, c.n, c.d1, c.d2)),
        blocks,
        *(given[first] for given in (c.mu_v, c.mu_omega, c.rows)),
    )
    bodies = np.stack([step.M_u[i : i + 6, i : i + 6] for i in range(0, n_v, 6)])
    M_u = np.tile(bodies, (times, 1, 1))
    none = np.zeros(0)
    constant = constants(step.h, step.K_q, 0, M_u, contacts.rows, step.cone)
    loads = {"tau_a": none, "tau_u": np.tile(step.tau_u, times), "delta_q_bar_a": none}
    for array in loads.values():
        array.setflags(write=False)
    return posed(constant.kind, constant._asdict(), {**loads, "contacts": contacts})


def _pile(scene: Scene, certify: str) -> Pile:
    return pile(scene.shape, backend=None, certify=certify, gap=scene.gap, yaw=scene.yaw)


def alone(scene: Scene, certify: str) -> Cost:
    """The same in a process of its own, for its memory."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(cost, (scene, certify))


def costs(scenes: list[Scene]) -> tuple[list[str], dict[str, Cost]]:
    """The table of what some scenes cost, and the same by their names."""
    head = "scene, contacts, coordinates, groups, first [s], later [s], memory [MB], exact, "
    head += "later with residual [s], memory with residual [MB], ratio of times"
    rows = []
    found = {}
    for scene in scenes:
        full = alone(scene, "full")
        said = alone(scene, "residual")
        ratio = full.later / said.later
        found[scene.name] = replace(full, over_residual=ratio)
        sizes = [f"{n:,}" for n in (full.contacts, full.coordinates, full.groups)]
        measured = [f"{full.first:.3g}", f"{full.later:.3g}", f"{full.memory:.0f}"]
        rows.append([scene.name, *sizes, *measured, f"{full.exact} of {1 + STEPS}"])
        rows[-1] += [f"{said.later:.3g}", f"{said.memory:.0f}", f"{ratio:.1f}"]
    return markdown_table(head.split(", "), rows), found


def random_case(seed: int) -> StepData:
    """A random step, mostly without what couples two or three classes of its coordinates."""
    rng = np.random.default_rng([seed, 3])
    return divided(rng, mixed_step(seed), int(rng.integers(1, 4)))


def faults(step: StepData) -> list[str]:
    """In what the optimum by group is not that of the whole; empty if it is."""
    whole = form_optimum(exact_form(step))
    try:
        grouped = step_optimum(step)
    except StepInfeasible as failure:
        if not isinstance(whole, Farkas):
            return ["infeasible by group only"]
        reason = farkas_refutation(step, failure.farkas.exact)
        return [] if reason is None else [reason]
    except StepIllPosed as failure:
        if isinstance(whole, Farkas):
            return ["feasible by group only"]
        return [] if failure.delta_q.tobytes() == whole.delta_q.tobytes() else ["delta_q"]
    return unlike(grouped, whole)


def unlike(one: ExactOptimum, whole: ExactOptimum | Farkas) -> list[str]:
    """In what of that no choice is left of an optimum is not that of the whole step."""
    if isinstance(whole, Farkas):
        return ["feasible by group only"]
    names = (*SAME, "lam") if whole.multipliers_unique else SAME
    return [name for name in names if bits(getattr(one, name)) != bits(getattr(whole, name))]


def compared(random: int, every: int) -> tuple[list[str], list[str]]:
    """The table of how many steps were compared, whole and by group; what differs, in words."""
    found = Counter()
    wrong = []
    for seed in range(random):
        step = random_case(seed)
        found[f"random steps of {len(groups(step))} groups"] += 1
        wrong += [f"random step {seed}: {fault}" for fault in faults(step)]
    for name in scenario_names():
        run = load_scenario(name, fast=True).run(progress=False)
        for k in range(0, run.steps, every):
            found[f"steps of {name}"] += 1
            wrong += [f"{name}, step {k}: {fault}" for fault in faults(run.step_data(k))]
    return markdown_table(("steps", "compared"), sorted(found.items())), wrong


def main() -> int:
    """Measure, compare, and write the page."""
    options = asked(__doc__, random=1000, every=30, out=Path)
    # Of the processes that measure: a thread of BLAS that waits for another counts as time.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    m = machine()
    words = (
        f"Written by `python -m validation.make.grouped_proofs` on {m['processor']}, "
        f"{m['cores']} cores, Python {m['python']}: processor time of a step with `fast`, the "
        f"median of {STEPS} after the first, and the peak memory of its process, in which BLAS has "
        "one thread. Four contacts a pair, six rows a contact."
    )
    separate, found = costs([*SEPARATE, *COPIED])
    touching, connected = costs(CONNECTED)
    steps, wrong = compared(options.random, options.every)
    measured = []
    for how in ("aligned", "yawed"):
        few, many, most = (found[f"{n} separate boxes, {how}"] for n in ("10", "40", "1,000"))
        measured.append((f"40 boxes over 10, {how}", many.later / few.later, AT_MOST))
        measured.append((f"1,000 boxes, {how} [s]", most.later, SECONDS))
    heap = connected["a heap of 5 x 5 x 4, pushed"]
    measured.append(("a heap of 1,040 contacts [s]", max(heap.first, heap.later), HEAP))
    for name, one in connected.items():
        if one.contacts in HUNDRED:
            measured.append((f"{name}: over residual", one.over_residual, OVER_RESIDUAL))
    measured.append(("steps whose bits differ", float(len(wrong)), 0.0))
    promised, kept = promises(measured)
    same = "`delta_q`, `A'lam`, slacks and what is said of them, by group and of the whole step:"
    lines = [
        "# Proofs by group, and of connected scenes", "", words,
        "", "## Boxes that do not touch each other", "", *separate,
        "", "## Boxes in contact", "", *touching,
        "", "## The same bits", "", same, "", *steps,
        "", "## Promises", "", *promised,
    ]  # fmt: skip
    shown("\n".join(lines), options.out)
    print(*wrong, sep="\n", file=sys.stderr)
    return int(not kept)


if __name__ == "__main__":
    sys.exit(main())
