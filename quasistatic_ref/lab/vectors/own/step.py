"""A whole step by the package itself: its System, pairs, simulator and exact method.

No backend guesses: the answer is the same, and CVXPY would compile each case.
"""

from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.failures import StepInfeasible
from quasistatic_ref.certify.groups import group_steps
from quasistatic_ref.contact.all_pairs import closest_points
from quasistatic_ref.contact.closest_points import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.forces import COMPLIANCE
from quasistatic_ref.lab.program.rotation import rotation
from quasistatic_ref.lab.vectors.own.shapes import own_shape
from quasistatic_ref.lab.vectors.own.system import OwnSystem, own_system
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.forces.forces import contact_forces
from quasistatic_ref.optional.forces.of_group import group_compliance
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.simulate.form_step import form_step
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Contacts, StepData
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.step.standard_form import standard_form

COARSER = 2.0**18
"""Compliance of a case over that of a run [-]. Forces are known as well as phi over the compliance:
what float64 leaves open of them is at most 1e-5 of the largest, or of 1 N, in the vectors. Half the
compliance changes the forces of a case by more."""


class PosedCase(NamedTuple):
    """The step that a case of the layer `step` poses, by the package itself.

    Parameters
    ----------
    mine : OwnSystem
    simulator : Simulator
    q : ndarray, shape (n_q,)
    q_bar_a : ndarray, shape (n_q_a,)
    force : ndarray, shape (n_v,)
        Generalised force of the wrenches [N, N m].
    points : ClosestPoints
    step : StepData
    """

    mine: OwnSystem
    simulator: Simulator
    q: Array
    q_bar_a: Array
    force: Array
    points: ClosestPoints
    step: StepData


def posed_case(case_input: Json) -> PosedCase:
    """The step of a case of the layer `step`."""
    mine = own_system(case_input["mechanism"])
    system = mine.system
    n_a = mine.system.n_a
    pairs = [_pair(pair, case_input["shapes"], mine) for pair in case_input["pairs"]]
    K_q = np.zeros((n_a, n_a))
    K_q[np.ix_(mine.v[:n_a], mine.v[:n_a])] = np.reshape(case_input["K_q"], (n_a, n_a))
    simulator = Simulator(
        system,
        pairs,
        h=case_input["h"],
        K_q=K_q,
        gravity=case_input["gravity"],
        cone=case_input["cone"],
        backend="none",
    )
    q = mine.model_q(case_input["q"])
    n_q_a = len(case_input["q_bar_a"])
    target = mine.model_q([*case_input["q_bar_a"], *case_input["q"][n_q_a:]])
    kinematics = system.kinematics(q)
    points = closest_points(pairs, kinematics)
    # Pairs keep their order; within one the contacts stand by index here, by distance there.
    order = np.lexsort((points.point, np.repeat(np.arange(len(pairs)), [p.n_c for p in pairs])))
    points = points.chosen(order)
    force = wrench_force(case_input, mine, q)
    q_bar_a = target[: system.n_q_a]
    step = form_step(simulator.plan, system.at(q), q_bar_a, force, points)
    return PosedCase(mine, simulator, q, q_bar_a, force, points, step)


def own_step(case_input: Json) -> Json:
    """The package's own answer to a case of the layer `step`."""
    mine, simulator, q, _, _, points, step = posed_case(case_input)
    at = step.contacts
    output = _program(step, mine)
    output["contacts"] = [
        {
            "pair": simulator.plan.layout.names[j],
            "index": int(points.point[j]),
            "alpha": points.alpha[j].tolist(),
            "beta": points.beta[j].tolist(),
            **{key: _plain(at, key, j, mine) for key in ("phi", "n", "d1", "d2", "J")},
        }
        for j in range(at.n_c)
    ]
    try:
        solution = simulator.solution(step)
    except StepInfeasible as failure:
        return {**output, "farkas": failure.farkas.y.tolist()}
    after = mine.system.integrate(q, solution.delta_q)
    lam = solution.lam[: step.offsets[-1]]
    return {
        **output,
        "delta_q": solution.delta_q[mine.v].tolist(),
        "lam": lam.tolist(),
        "A_lam": (np.array(output["A"]).reshape(-1, step.n_v).T @ lam).tolist(),
        "wrench": solution.wrench.tolist(),
        **_forces(case_input, simulator, solution),
        "q_next": (after[mine.q] + 0.0).tolist(),
    }


def _forces(case: Json, simulator: Simulator, solution: StepSolution) -> Json:
    """The forces by the compliances of a case, where contacts of a group have one."""
    compliance_of = {pair["name"]: pair.get("compliance", COMPLIANCE) for pair in case["pairs"]}
    each = np.array([compliance_of[name] for name in simulator.plan.layout.names])
    try:
        forces = contact_forces(solution.step, each, (solution.delta_q, solution.wrench))
    except InputError:
        return {}
    return {"forces": forces.wrench.tolist()}


def with_compliance(case: Json) -> Json:
    """A case of the layer `step` whose pairs have a compliance, COARSER than a run's."""
    posed = posed_case(case)
    compliances = np.zeros(posed.step.contacts.n_c)
    for group, part in group_steps(posed.step):
        compliances[group.contacts] = COARSER * group_compliance(part)
    by_pair = dict(zip(posed.simulator.plan.layout.names, compliances.tolist(), strict=True))
    return {**case, "pairs": [{**p, "compliance": by_pair[p["name"]]} for p in case["pairs"]]}


def _pair(pair: Json, shapes: Json, mine: OwnSystem) -> ContactPair:
    sides = []
    for side in ("alpha", "beta"):
        entry = shapes[pair[side]]
        R = rotation(entry["pose"]["quaternion"])
        t = np.array(entry["pose"]["xyz"], dtype=np.float64)
        shape = own_shape(entry["shape"])
        sides.append(PlacedShape(pair[side], mine.links[entry["body"]], R, t, shape))
    mu_v, mu_omega, rows, k = (pair[key] for key in ("mu_v", "mu_omega", "rows", "k"))
    return ContactPair(pair["name"], sides[0], sides[1], mu_v, mu_omega, rows, k)


def wrench_force(case: Json, mine: OwnSystem, q: Array) -> Array:
    """Generalised force of the wrenches, shape (n_v,); one on a fixed body has no effect."""
    system = mine.system
    force = np.zeros(system.n_v)
    for wrench in case.get("wrenches", []):
        link = mine.links[wrench["body"]]
        if system.column_map.moves[link].any():
            force += system.load(q, system.links[link], wrench["force"], wrench["torque"])
    return force


def _program(step: StepData, mine: OwnSystem) -> Json:
    form = standard_form(step)
    v = mine.v
    H = form.H[np.ix_(v, v)]
    A = form.A[:, v]
    return {"H": H.tolist(), "g": form.g[v].tolist(), "A": A.tolist(), "b": form.b.tolist()}


def _plain(at: Contacts, key: str, j: int, mine: OwnSystem) -> Json:
    value = getattr(at, key)[j]
    return value[:, mine.v].tolist() if key == "J" else value.tolist()
