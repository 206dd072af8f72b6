"""Random states: of every scenario, every couple of shapes, many contacts, random mechanisms."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import SimpleNamespace
from typing import Any, Final

import numpy as np

from quasistatic_ref import load_scenario
from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.scenes.pushes import SHAPES, pushed
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.precision import numbers
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.derivative_kinks import onto
from quasistatic_ref.lab.vectors.families.derivative_pairs import pair_kinds, placed_at, pressed
from quasistatic_ref.lab.vectors.families.mechanisms import ORIGIN, few_digits, link, mass
from quasistatic_ref.lab.vectors.families.random_scenes import random_scene
from quasistatic_ref.lab.vectors.families.scenario_mechanism import mechanism_of, pairs_of
from quasistatic_ref.lab.vectors.families.step_scenes import scene
from quasistatic_ref.lab.vectors.own.step import posed_case
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array
from tests.oracles.differences import unit
from tests.oracles.gradients.contacts import starts

COUPLES: Final = [(a, b) for a in SHAPES for b in SHAPES if not a == b == "cloud"]
TURN: Final = ("pushes", "scenario", "pushes", "pair", "scenario",
               "pushes", "random", "scenario", "pushes", "crowd")  # fmt: skip
"""Of ten states in a row the k-th is of this group."""
CROWD: Final = 24
"""Points of a body of which up to 20 are kept."""


@dataclass(frozen=True)
class State:
    """A step to be differentiated, for the package and for the reference.

    Parameters
    ----------
    group, name : str
        One of TURN, and the scenario or the shapes.
    simulator : Simulator
    q, q_bar_a, force : ndarray
        As :func:`~quasistatic_ref.optional.derivatives.derivatives.derivatives` takes them.
    case : dict
        The same step as an input of the layer ``step``, with the force as ``tau``.
    starts : list
        Closest pairs in float64.
    order : ndarray of int
        Which coordinate of the System each of the case's is.
    links : ndarray of int
        Link of each body of the case that has a mass.
    """

    group: str
    name: str
    simulator: Simulator
    q: Array
    q_bar_a: Array
    force: Array
    case: Json
    starts: list[Witness | None]
    order: np.ndarray
    links: np.ndarray


def state(i: int) -> State | None:
    """The i-th state; None where a scene at random has no solution or is none."""
    group = TURN[i % len(TURN)]
    turn = i // len(TURN) * TURN.count(group) + TURN[: i % len(TURN)].count(group)
    rng = np.random.default_rng([19, i])
    try:
        return GROUPS[group](rng, turn)
    except QuasistaticError:
        return None


def _of_scenario(rng: np.random.Generator, turn: int) -> State:
    names = scenario_names()
    name = names[turn % len(names)]
    scenario, run, table = _ran(name)
    system = scenario.system
    k = int(rng.integers(run.steps))
    q = system.integrate(run.q[k], 10 ** rng.uniform(-4, -2) * unit(rng, system.n_v))
    t = (k + 1) * scenario.h
    target = scenario.targets(t)
    force = np.zeros(system.n_v)
    if scenario.force is not None:
        force = force + scenario.force(t, q)
    if rng.integers(2):
        # About as large as what the scene has to bear, so that contacts slide and part.
        push = rng.uniform(0, 20) * float(system.masses.sum()) * unit(rng, system.n_v)
        force += push * np.where(np.arange(system.n_v) % 6 < 3, 1.0, 0.05)
    return whole_state("scenario", name, scenario.simulator(), table, q, target, force)


@lru_cache(maxsize=16)
def _ran(name: str) -> tuple[Scenario, Any, Json]:
    scenario = load_scenario(name, fast=True)
    return scenario, scenario.run(progress=False), _table(scenario)


def _table(scenario: Any) -> Json:
    shapes, pairs = pairs_of(scenario)
    return {
        "mechanism": mechanism_of(scenario),
        "shapes": shapes,
        "pairs": pairs,
        "h": scenario.h,
        "K_q": scenario.K_q.tolist(),
        "gravity": np.asarray(scenario.gravity).tolist(),
        "cone": scenario.cone,
    }


def whole_state(
    group: str,
    name: str,
    simulator: Simulator,
    table: Json,
    q: Array,
    q_bar_a: Array,
    force: Array,
) -> State:
    """A state whose case has the coordinates of its System."""
    system = simulator.system
    case = {**table, "q": q.tolist(), "q_bar_a": np.asarray(q_bar_a).tolist()}
    case |= {"tau": numbers(force.tolist()), "wrenches": []}
    named = [b["name"] for b in table["mechanism"]["bodies"] if "mass" in b]
    links = np.array([system.link(x) for x in named], dtype=int)
    at = starts(simulator, system.kinematics(q))
    return State(group, name, simulator, q, q_bar_a, force, case, at, np.arange(system.n_v), links)


def _of_case(group: str, name: str, table: Json) -> State:
    """The state of an input of the layer ``step``."""
    posed = posed_case(table)
    mine, q = posed.mine, posed.q
    tau = posed.force[mine.v]
    case = {**table, "wrenches": [], "tau": numbers(tau.tolist())}
    bodies = table["mechanism"]["bodies"]
    links = np.array([mine.links[b["name"]] for b in bodies if "mass" in b], dtype=int)
    at = starts(posed.simulator, mine.system.kinematics(q))
    return State(
        group, name, posed.simulator, q, posed.q_bar_a, posed.force, case, at, mine.v, links
    )


def _of_pushes(rng: np.random.Generator, turn: int) -> State:
    couple = COUPLES[turn % len(COUPLES)]
    k, gap = int(rng.choice([1, 2, 3, 4, 8])), float(rng.choice([1e-4, -1e-4, 4e-4, -2e-3]))
    cone = str(rng.choice(["pyramid", "pyramid", "product", "facets-6"]))
    simulator, q, q_bar_a = pushed(rng, *couple, k=k, gap=gap, cone=cone)
    system = simulator.system
    force = np.zeros(system.n_v)
    if rng.integers(2):
        force[6:] = rng.uniform(0, 8) * unit(rng, 6) * [1, 1, 1, 0.05, 0.05, 0.05]
    return whole_state(
        "pushes", "-".join(couple), simulator, table_of(simulator), q, q_bar_a, force
    )


def table_of(simulator: Simulator) -> Json:
    """What of an input of the layer ``step`` is the same at every configuration."""
    system = simulator.system
    bodies = {body.name: SimpleNamespace(body=body) for body in system.bodies}
    parts = {key: getattr(simulator, key) for key in ("pairs", "h", "K_q", "gravity", "cone")}
    return _table(SimpleNamespace(bodies=bodies, system=system, **parts))


def _of_pair(rng: np.random.Generator, turn: int) -> State:
    kinds = pair_kinds()
    couple = list(kinds[turn % len(kinds)])
    rng.shuffle(couple)
    moving = str(rng.choice(["alpha", "beta"]))
    if "halfspace" in couple:
        moving = ("beta", "alpha")[couple.index("halfspace")]
    table = pressed(rng, *couple, moving, driven=bool(rng.integers(2)))
    return _of_case("pair", "-".join(couple), table)


def _at_random(rng: np.random.Generator, turn: int) -> State:
    table = random_scene(rng, hard=bool(turn % 3 == 2))
    return _of_case("random", "mechanisms", table)


def _of_crowd(rng: np.random.Generator, turn: int) -> State:
    """A body of many points at about the same height, of which 1 to 20 are kept."""
    k = turn % 20 + 1
    points = rng.uniform(-0.05, 0.05, (CROWD, 3))
    points[:, 2] = rng.uniform(0, 10 ** rng.uniform(-4, -2), CROWD)
    under = str(rng.choice(["halfspace", "box", "sphere", "ellipsoid", "cylinder"]))
    flat = {
        "halfspace": {"kind": "halfspace", "normal": [0.1, 0.05, 1.0], "offset": 0.0},
        "box": {"kind": "box", "size": [0.4, 0.4, 0.1]},
        "sphere": {"kind": "sphere", "radius": 0.5},
        "ellipsoid": {"kind": "ellipsoid", "half_axes": [0.4, 0.5, 0.3]},
        "cylinder": {"kind": "cylinder", "radius": 0.4, "length": 0.3},
    }[under]
    cloud = {"kind": "cloud", "points": [few_digits(x, 5) for x in points]}
    gap = float(rng.choice([1e-4, -1e-4, 0.0]))
    place, n = placed_at(rng, {"alpha": flat, "beta": cloud}, "beta", gap)
    body = link("body", None, "floating", **mass(rng))
    table = scene(
        [body],
        {"body": {"body": "body", "pose": ORIGIN, "shape": cloud}},
        [*place["xyz"], *place["quaternion"]],
        pairs=[],
        cone=str(rng.choice(["pyramid", "pyramid", "product"])),
    )
    rows = int(rng.choice([4, 6]))
    table = onto(table, "ground", flat, k=k, mu_v=0.4, mu_omega=0.01, rows=rows)
    force = -rng.uniform(0, 30) * body["mass"] * (n + 0.6 * rng.uniform(-1, 1, 3))
    torque = rng.uniform(0, 0.5) * rng.uniform(-1, 1, 3)
    wrench = {"body": "body", "force": few_digits(force), "torque": few_digits(torque)}
    return _of_case("crowd", f"{k}-{under}", {**table, "wrenches": [wrench]})


GROUPS: Final = {
    "scenario": _of_scenario,
    "pushes": _of_pushes,
    "pair": _of_pair,
    "random": _at_random,
    "crowd": _of_crowd,
}


def states(indices: Sequence[int]) -> Iterator[tuple[int, State | None]]:
    """Some states with their numbers."""
    for i in indices:
        yield i, state(i)
