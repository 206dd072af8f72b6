"""How far derivatives hold: ``python -m validation.make.reach [--count N] [--out FILE]``.

In settled scenes, where the reach along a random direction of q, targets and forces exceeds 1e-6
natural units, a central difference over a tenth of it is compared with the derivatives.
Along random forces on blocks and on pairs of the vectors, of which a step is a piecewise linear
function, the rows that touch in the
exact steps just before and just after the next kink are to differ by the rows that are named.
Exit status 1 if a difference is off, or other rows are named. ``--count`` is that of states a
scene; records are kept in ``--log FILE``, from which the same command goes on.
"""

import sys
from functools import cache
from pathlib import Path

import numpy as np

from quasistatic_ref import load_scenario
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.parallel import Log, Record
from quasistatic_ref.lab.scenes.systems import on_link, world_plane
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.derivatives.data_rates import parameter_units
from quasistatic_ref.optional.derivatives.derivatives import Derivatives, derivatives
from quasistatic_ref.optional.derivatives.step.reason import ZERO_FRICTION
from quasistatic_ref.optional.derivatives.step.touching import touching_rows
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.shapes.placed_shape import Box
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array
from tests.lab.vectors.material import cases
from tests.optional.derivatives.free_bodies import vector_scene
from tests.oracles.differences import after, rate
from validation.tools.scripts import asked, shown

SCENES = {
    "allegro_turn": 100, "block_incline": 100, "block_push": 100, "bunny_grasp": 80, "door": 100,
    "peg_in_hole": 100, "sphere_spin": 100, "stack": 50, "two_finger_pinch": 100,
}  # fmt: skip
"""Steps of each scene of models/ but panda_push, whose closest points are not unique."""
FIRST = 10
"""The step from which a scene counts as settled."""
REACH, ERROR, FARTHEST = 1e-6, 1e-6, 0.1
"""The reach from which differences are compared, what they may be off, over the largest entry, and
the natural units beyond which they show the curvature of a step."""
ASIDE = 1e-3
"""How far from a kink the steps on both sides of it are, over its distance."""
BY = ("q", "q_bar_a", "tau")
BLOCK = Box(np.array([0.1, 0.08, 0.05]))
ARM = np.array([1.0, 1.0, 1.0, 0.05, 0.05, 0.05])
"""Of random forces [N] and torques [N m] on a base."""
PAGE = """# How far derivatives hold

Made by `python -m validation.make.reach`. In each state, a random direction of q, targets and
forces, of length one in natural units (the sum of all parts). A difference is a central one over a
tenth of the reach along it, of at most {farthest:g}; it is compared where that exceeds {reach:g},
and the largest is given over the largest entry of the derivatives.

{states}
Kinks along random forces: how many are at the distance and at the rows that are named.

{kinks}"""


@cache
def scene(name: str) -> tuple[Scenario, Simulator, Array]:
    """A scene, what steps it, and its configurations."""
    found = load_scenario(name, steps=SCENES[name], fast=True)
    return found, found.simulator(), found.run(progress=False).q


def state(key: str) -> Record:
    """How far derivatives along a random direction hold, and what a difference says of them."""
    _, name, number = key.split()
    found, simulator, run = scene(name)
    k = int(number)
    q = run[k]
    target = found.targets((k + 1) * found.h)
    here = derivatives(simulator, q, target, nearly=0.0)
    record = {"key": key, "reach": 0.0, "error": None}
    if any(why.kind != ZERO_FRICTION for why in here.reasons):
        return record
    rng = np.random.default_rng([k, *name.encode()])
    units = parameter_units(simulator, here.result.step)
    sizes = [units[f"dq_d{by}"] for by in BY]
    way = rng.normal(size=sum(map(len, sizes)))
    parts = np.split(way / np.abs(way).sum(), np.cumsum([len(unit) for unit in sizes])[:-1])
    e = {by: part * unit for by, part, unit in zip(BY, parts, sizes, strict=True)}
    back = {by: -part for by, part in e.items()}
    reach = min(here.reach_along(**e).distance, here.reach_along(**back).distance)
    record["reach"] = min(reach, FARTHEST)
    if reach > REACH:
        record["error"] = difference(simulator, q, target, here, e, record["reach"])
    return record


def difference(
    simulator: Simulator, q: Array, target: Array, found: Derivatives, e: dict[str, Array], t: float
) -> float:
    """How far a central difference over t / 10 of a direction is off, over the largest entry."""
    system = simulator.system
    change = np.concatenate([e["q_bar_a"], np.zeros(system.n_u)])
    whole = system.with_actuated(q, target)

    def moved(t: float) -> Array:
        start = system.integrate(q, t * e["q"])
        goal = system.integrate(whole, t * change)[: system.n_q_a]
        return np.asarray(after(simulator, found.result.q, start, goal, t * e["tau"]))

    units = parameter_units(simulator, found.result.step)
    entries = [getattr(found, f"dq_d{by}") * units[f"dq_d{by}"] for by in BY]
    largest = max(np.abs(each).max(initial=0.0) for each in entries)
    there = rate(moved, t / 20)  # it takes twice that as well
    return float(np.abs(there - found.along(**e)).max() / largest)


def block(rng: np.random.Generator) -> tuple[Simulator, Array, Array]:
    """A block that lies on the floor with four corners, somewhere."""
    place = (*rng.uniform(-0.2, 0.2, 2), BLOCK.half_extents[2])
    turn = (0.0, 0.0, rng.uniform(-3, 3))
    system = System([Body.of_shape("block", BLOCK, 0.3, xyz=place, rpy=turn)])
    pair = ContactPair("floor", world_plane(), on_link(system, "block", BLOCK), 0.4, 0.01, 6, 4)
    simulator = Simulator(system, [pair], h=0.01, K_q=np.zeros((0, 0)), fast=True)
    return simulator, system.q_start, np.zeros(0)


def kink(key: str) -> Record:
    """Whether the rows that touch change as is said, where a random force has grown so far."""
    _, what, seed = key.split()
    rng = np.random.default_rng([int(seed), *what.encode()])
    if what == "block":
        simulator, q, target = block(rng)
    else:
        names = [case.id for case in cases("derivative") if "/pair/" in case.id]
        simulator, q, target = vector_scene(str(rng.choice(names)).partition("/")[2])
    arms = np.resize(ARM, simulator.system.n_v)
    force, way = 0.1 * arms * rng.normal(size=(2, len(arms)))
    here = derivatives(simulator, q, target, force)
    ahead = here.reach_along(tau=way) if here.differentiable else None
    if ahead is None or not np.isfinite(ahead.distance):
        return {"key": key, "named": None}
    before, beyond = (
        touching(simulator, q, target, force + (1 + side) * ahead.distance * way)
        for side in (-ASIDE, ASIDE)
    )
    named = before ^ beyond == set(ahead.where.split(", "))
    return {"key": key, "named": named}


def touching(simulator: Simulator, q: Array, target: Array, force: Array) -> set[str]:
    """The rows that touch in a step."""
    result = simulator.step(q, target, force)
    far = np.abs(np.stack([result.points.alpha, result.points.beta])).max(axis=(0, 2))
    found = touching_rows(result.solution, far)
    step = result.step
    names = cone(step.cone).row_names
    rows = np.concatenate([found.strict, found.idle])
    return {f"row {names[i]} of {step.contacts.name[j]}" for j, i in rows}


def keys(count: int) -> tuple[list[str], list[str]]:
    """Of so many states in each scene, and so many kinks of each kind."""
    states = [
        f"state {name} {k}"
        for name, steps in SCENES.items()
        for k in sorted({*np.linspace(FIRST, steps - 1, count).astype(int).tolist()})
    ]
    return states, [
        f"kink {what} {seed}" for what in ("block", "pair") for seed in range(3 * count)
    ]


def page(records: list[Record]) -> tuple[str, bool]:
    """The committed page, and whether all is as said."""
    groups: dict[str, list[Record]] = {}
    for record in records:
        groups.setdefault(record["key"].rpartition(" ")[0], []).append(record)
    states = []
    kinks = []
    good = True
    for name, own in groups.items():
        what = name.partition(" ")[2]
        if name.startswith("kink"):
            said = [record["named"] for record in own if record["named"] is not None]
            kinks.append((what, len(own), len(said), sum(said)))
            good &= all(said)
            continue
        errors = [record["error"] for record in own if record["error"] is not None]
        least = min(record["reach"] for record in own)
        worst = max(errors, default=0.0)
        states.append((what, len(own), f"{least:.1g}", len(errors), f"{worst:.1g}"))
        good &= worst <= ERROR
    text = PAGE.format(
        farthest=FARTHEST,
        reach=REACH,
        states=table(("scene", "states", "least reach", "compared", "largest"), states),
        kinks=table(("scenes", "steps", "with a kink ahead", "as named"), kinks),
    )
    return text, good


def table(head: tuple[str, ...], rows: list[tuple[object, ...]]) -> str:
    """A table in Markdown."""
    return "\n".join([*markdown_table(head, rows, 1), ""])


def main() -> int:
    """Compare, and write the page."""
    options = asked(__doc__, count=75, out=Path, log=Path)
    states, kinks = keys(options.count)
    log = Log(options.log, lambda record: record["key"])
    found = [*log.records(states, state), *log.records(kinks, kink)]
    text, good = page(found)
    shown(text, options.out)
    return int(not good)


if __name__ == "__main__":
    sys.exit(main())
