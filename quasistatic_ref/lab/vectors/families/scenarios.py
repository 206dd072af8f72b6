"""Inputs from every scenario that comes with the package: some steps of each run."""

from collections.abc import Callable, Iterator
from typing import Final

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families.derivative import kinds_of
from quasistatic_ref.lab.vectors.families.scenario_mechanism import (
    mechanism_of,
    pairs_of,
    pose_of,
    shape_of,
)
from quasistatic_ref.lab.vectors.families.steps import (
    PLACE,
    contact_entries,
    program,
    rows_input,
    wrench_input,
)
from quasistatic_ref.lab.vectors.files import Case
from quasistatic_ref.lab.vectors.layers import layer
from quasistatic_ref.model.system import Kinematics
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.target import piecewise_linear
from quasistatic_ref.step.data import Array

Found = Iterator[tuple[str, Case]]
Say = Callable[[str], None]
SHARES: Final = (0.0, 0.3, 0.6)
"""Where in a run steps are taken, two in a row each."""
FEW: Final = 40
"""Points of a cloud in a case of the layer distance."""


def scenario_cases(say: Say) -> Found:
    """Layer and case, of all scenarios.

    Parameters
    ----------
    say : callable
        Called with which scenario runs, and which steps are left out.
    """
    for name in scenario_names():
        say(f"{name} ...")
        yield from _cases(name, load_scenario(name, fast=True), say)


def _cases(name: str, scenario: Scenario, say: Say) -> Found:
    system = scenario.system
    simulator = scenario.simulator()
    mechanism = mechanism_of(scenario)
    shapes, pairs = pairs_of(scenario)
    fixed = {"mechanism": mechanism, "shapes": shapes, "pairs": pairs, "h": scenario.h}
    fixed |= {"K_q": scenario.K_q.tolist(), "gravity": scenario.gravity.tolist()}
    fixed |= {"cone": scenario.cone}
    starts = [int(share * scenario.steps) for share in SHARES]
    wanted = {k for start in starts for k in (start, start + 1)}
    q = system.q_start
    for k in range(max(wanted) + 1):
        t = (k + 1) * scenario.h
        goal = scenario.targets(t)
        force = 0.0 if scenario.force is None else scenario.force(t, q)
        result = simulator.step(q, goal, force)
        if k in wanted:
            case = {**fixed, "q": q.tolist(), "q_bar_a": goal.tolist()}
            if scenario.wrenches:
                case["wrenches"] = _wrenches(scenario, t)
            where = f"step {k} of the scenario {name}"
            yield from _whole(f"step/{name}/{k}", where, case, say)
            if k == starts[-1] and kinds_of(case) == set():
                yield "derivative", Case(f"derivative/{name}/{k}", where, case)
            if k in starts[1:]:
                kinematics = system.kinematics(q)
                yield from _parts(f"{name}/{k}", where, scenario, case, result, kinematics)
                yield from _distances(f"{name}/{k}", where, scenario.pairs, kinematics)
        q = result.q


def _whole(name: str, where: str, case: Json, say: Say) -> Found:
    """The step itself, unless rounding decides which contacts are kept.

    Where it decides at which point of parallel faces they lie, the checker takes any.
    """
    if layer("step").expected(case).flags["tie"]:
        say(f"  {name} is left out: its closest points are tied")
        return
    yield "step", Case(name, where, case)


def _parts(
    name: str,
    where: str,
    scenario: Scenario,
    case: Json,
    result: StepResult,
    kinematics: Kinematics,
) -> Found:
    """The same step, layer by layer."""
    at = result.step.contacts
    points = result.points
    links = scenario.system.links
    layout = scenario.simulator().layout
    bodies = [
        tuple(None if link == 0 else links[link] for link in pair)
        for pair in zip(layout.link_alpha, layout.link_beta, strict=True)
    ]
    places = [
        dict(zip(PLACE, (*pair, alpha.tolist(), beta.tolist()), strict=True))
        for pair, alpha, beta in zip(bodies, points.alpha, points.beta, strict=True)
    ]
    yield "rows", Case(f"rows/{name}", where, rows_input(at, scenario.cone))
    yield "qp", Case(f"qp/{name}", where, program(result.step))
    touched = {link for pair in bodies for link in pair if link is not None}
    about = {link: {"point": kinematics.t[links.index(link)].tolist()} for link in sorted(touched)}
    lam = result.solution.lam
    wrench = wrench_input(at, scenario.cone, scenario.h, lam, places, about)
    yield "wrench", Case(f"wrench/{name}", where, wrench)
    tree = {"mechanism": case["mechanism"], "q": case["q"]}
    frames = contact_entries(at, ("n", "d1", "d2"))
    contacts = [place | frame for place, frame in zip(places, frames, strict=True)]
    yield "jacobian", Case(f"jacobian/{name}", where, {**tree, "contacts": contacts})
    after = {**tree, "delta_q": result.solution.delta_q.tolist()}
    yield "integrate", Case(f"integrate/{name}", where, after)
    groups = [_cloud_distances(pair, kinematics) for pair in scenario.pairs]
    clouds = [phi for phi in groups if phi is not None]
    if clouds:
        selection = {"phi": clouds, "k": scenario.pairs[0].k}
        yield "selection", Case(f"selection/{name}", where, selection)


def _distances(
    name: str, where: str, pairs: tuple[ContactPair, ...], kinematics: Kinematics
) -> Found:
    """The pairs of a step, one case each; of a cloud some points only."""
    for i, pair in enumerate(pairs):
        case: Json = {}
        for side, placed in (("alpha", pair.alpha), ("beta", pair.beta)):
            shape = shape_of(placed.shape)
            if isinstance(placed.shape, PointCloud):
                points = shape["points"]
                shape = {**shape, "points": points[:: -(-len(points) // FEW)]}
            case |= {side: shape, f"pose_{side}": pose_of(*_frame(placed, kinematics))}
        yield "distance", Case(f"distance/{name}/{i}", f"{where}: {pair.name}", case)


def _cloud_distances(pair: ContactPair, kinematics: Kinematics) -> Json | None:
    """Signed distances of a cloud to the pair's solid; None of two solids."""
    cloud = pair.beta
    solid = pair.alpha
    if not isinstance(cloud.shape, PointCloud):
        return None
    (R, t), (R_s, t_s) = (_frame(placed, kinematics) for placed in (cloud, solid))
    in_solid = (cloud.shape.points @ R.T + t - t_s) @ R_s
    return solid.shape.signed_distance(in_solid)[0].tolist()


def _frame(placed: PlacedShape, kinematics: Kinematics) -> tuple[Array, Array]:
    R = kinematics.R[placed.link]
    t = kinematics.t[placed.link]
    return R @ placed.R, R @ placed.t + t


def _wrenches(scenario: Scenario, t: float) -> Json:
    """External wrenches at a time, each on the link that its body's base moves."""
    found = []
    for wrenches in scenario.wrenches:
        value = piecewise_linear(wrenches.times, wrenches.values, t)
        link = scenario.system.links[scenario.system.link(wrenches.body)]
        force, torque = np.split(value, 2)
        found.append({"body": link, "force": force.tolist(), "torque": torque.tolist()})
    return found
