"""The planar hand of quasistatic_simulator as a scene of ours, against runs of its own.

Its shapes and masses are those of its model ``planar_hand_ball`` (MIT licence), its runs those of
``validation/results/peer.json``, made once with Drake's wheel.
"""

from typing import Any

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.formats.files import json_read
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.folders import peer_file
from quasistatic_ref.lab.scenes.systems import joint_text, link_text, robot_text
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.derivatives.step.optimum_rates import DataRates, Equations
from quasistatic_ref.optional.derivatives.step.touching import touching_rows
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import StepData

TIGHT, AS_IT_COMES, DEFAULT = 1e-8, 1e-7, 1e-4
"""Of its runs with tolerances of 1e-12, with Clarabel's own and with OSQP [m, rad]: what these
solvers leave of each step, and 60 steps add up."""

HAND = {"left": -1.0, "right": 1.0}
"""The side of each arm [-]."""
STIFFNESS = {"joint_1": 50.0, "joint_2": 25.0}
BASE, LINK, RADIUS, BALL = 0.1, 0.3, 0.05, 0.25
"""Distance of the arms from the middle, length of their first link, radii [m]."""
LIGHT = (1e-6,) * 3
INSTANCES = ("sphere", "arm_left", "arm_right")
"""The peer's order of coordinates."""
ORDER = [4, 5, 6, 0, 1, 2, 3]
"""Where these are in ours."""


def arm(side: float) -> str:
    """An arm of two links, each of spheres, in the plane of y and z, to a `side`, +-1 [-]."""
    inertia = (0.0033,) * 3
    sphere = f'<geometry><sphere radius="{RADIUS}"/></geometry>'
    shapes = [
        "".join(
            f'<collision><origin xyz="0 {side * 0.1 * i:.1f} 0"/>{sphere}</collision>'
            for i in indices
        )
        for indices in ((0,), (1, 2, 3), (1, 2))
    ]
    links = [
        link_text(f"link_{i}", 1.0, inertia).replace("</link>", f"{shape}</link>")
        for i, shape in enumerate(shapes)
    ]
    joints = [
        joint_text("joint_1", "revolute", "link_0", "link_1"),
        joint_text("joint_2", "revolute", "link_1", "link_2", origin=f"0 {side * LINK} 0"),
    ]
    return robot_text(*links, *joints)


def ball() -> str:
    """A ball on two rails, which turns about x."""
    return robot_text(
        link_text("base", 1.0, LIGHT),
        link_text("along_y", 1e-6, LIGHT),
        link_text("along_z", 1e-6, LIGHT),
        link_text("sphere", 1.0, (0.025,) * 3, f'<sphere radius="{BALL}"/>'),
        joint_text("y", "prismatic", "base", "along_y", "0 1 0"),
        joint_text("z", "prismatic", "along_y", "along_z", "0 0 1"),
        joint_text("turn", "revolute", "along_z", "sphere", "1 0 0"),
    )


def our_steps(model: dict[str, Any]) -> list[StepResult]:
    """Each step of our scene, whose coordinates are joints of both arms, then those of the ball."""
    start = model["start"]
    bodies = [
        Body(
            name, arm(side), actuated="all", xyz=(0, side * BASE, 0),
            positions=dict(zip(STIFFNESS, start[f"arm_{name}"], strict=True)),
        )
        for name, side in HAND.items()
    ]  # fmt: skip
    y, z, turn = start["sphere"]
    system = System([*bodies, Body("ball", ball(), positions={"y": y, "z": z, "turn": turn})])
    sphere = next(shape for shape in system.shapes if shape.name.startswith("ball/"))
    arms = [shape for shape in system.shapes if shape is not sphere]
    pairs = [ContactPair(s.name, s, sphere, 0.8, 0.0, rows=4, k=1) for s in arms]
    K_q = {f"{name}/{joint}": k for name in HAND for joint, k in STIFFNESS.items()}
    simulator = Simulator(system, pairs, h=model["h"], K_q=K_q, gravity=(0.0, 0.0, 0.0))
    q = system.q_start
    results = []
    for k in range(model["steps"]):
        moved = min(k + 1, model["moving"])
        target = {
            f"{name}/{joint}": at + moved * rate
            for name in HAND
            for joint, at, rate in zip(
                STIFFNESS, start[f"arm_{name}"], model["rate"][f"arm_{name}"], strict=True
            )
        }
        results.append(simulator.step(q, system.placed(target)[: system.n_q_a]))
        q = results[-1].q
    return results


def data_rates(step: StepData) -> DataRates:
    """Rates of a step's data by targets, and by q while J, masses and loads stay as they are."""
    springs = step.h * np.pad(step.K_q, ((0, step.n_u), (0, 0)))
    load = np.hstack([springs, -springs, np.zeros((step.n_v, step.n_u))])
    motion = np.zeros((step.contacts.n_c, 4, load.shape[1]))
    motion[:, 0, step.n_a :] = np.einsum("jc,jcv->jv", step.contacts.n, step.contacts.J[:, :3])
    terms = np.abs(motion).max(axis=(0, 1), initial=0.0)
    return DataRates(load, motion, terms, lambda y: np.zeros(load.shape))


def gradients(answer: StepSolution) -> tuple[Array, Array]:
    """The peer's B and A: dq+/du (n_v, n_a) and dq+/dq (n_v, n_v); NaN where there is none."""
    step = answer.step
    rates = Equations(touching_rows(answer, np.zeros(step.contacts.n_c))).rates(data_rates(step))
    x = rates.x.copy()
    none = np.zeros(x.shape[1], dtype=bool)
    x[:, np.any([none, *rates.contradicts.values(), *rates.opens], axis=0)] = np.nan
    return x[:, : step.n_a], np.eye(step.n_v) + x[:, step.n_a :]


def evidence() -> Evidence:
    """Sixty steps, in which the hand closes and turns the ball, against three of its runs.

    Its gradients by targets, in every tenth step, are compared where ours exist.
    """
    peer = json_read(peer_file())
    results = our_steps(peer["model"])
    mine = np.array([result.q[ORDER] for result in results])
    every = len(results) // len(peer["gradients"])
    pairs = [
        (B, theirs["B"])
        for result, theirs in zip(results[::every], peer["gradients"], strict=True)
        if not np.isnan(B := gradients(result.solution)[0][ORDER]).any()
    ]
    assert pairs
    limits = {"clarabel 1e-12": TIGHT, "clarabel 1e-8": AS_IT_COMES, "osqp": DEFAULT}
    return Evidence.of(
        *(
            comparison(
                f"coordinates, {solver} [m, rad]",
                mine,
                np.hstack([np.array(peer["runs"][solver][name]) for name in INSTANCES]),
                limit,
            )
            for solver, limit in limits.items()
        ),
        comparison("dq+/du [-]", [B for B, _ in pairs], [B for _, B in pairs], TIGHT),
    )


CLAIM = Claim(
    name="peer",
    sentence="The planar hand of quasistatic_simulator, written as a scene of ours, goes the way "
    "of its own runs, and has its gradients.",
    where="Pang and Tedrake, quasistatic_simulator (c917755), Python path with Drake's solvers",
    sweep="two arms of two joints close on a ball and turn it, 60 steps of 50 ms; gradients "
    "of every tenth",
    reason="TIGHT, AS_IT_COMES, DEFAULT: what its solvers leave at their tolerances.",
    measure=evidence,
)
