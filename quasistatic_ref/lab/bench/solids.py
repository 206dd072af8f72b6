"""Steps of scenes of solids: separate boxes on a floor, and a hand that turns a drum."""

import re
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.lab.bench.grasp import bare_daqp
from quasistatic_ref.lab.bench.timing import Job, in_turn, least, microseconds, ratio
from quasistatic_ref.lab.scenes.systems import on_link, words, world_plane
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.optional.fast.adapters.program import Program, SparseProgram
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.shapes.placed_shape import Box
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array

H = 0.01
"""Time step [s]."""
HALF = 0.05
"""Half of a box's edge [m]."""
MASS = 0.5
"""Of a box [kg]."""
PUSH = np.array([1.5, 1.0, 0.0])
"""On each box [N]; friction, of 2.45 N, holds it. What slides here is thrown about in MuJoCo, whose
bodies have inertia, and its step is then another one."""
GAP = 4 * HALF
"""From the middle of a box to that of the next [m]."""
MU_V = 0.5
MU_OMEGA = 0.01
"""[m]"""
HAND = "hand with a drum"
FORCES = "full, forces"
UNCERTIFIED = "off"
PROVED = "full"
PLAIN = "full, plain"
MUJOCO = "MuJoCo"
SOLVER = "DAQP alone"
COLUMNS = (UNCERTIFIED, "residual", PROVED, FORCES, PLAIN, SOLVER, MUJOCO)


@dataclass(frozen=True, eq=False)
class Scene:
    """A scene for both engines.

    Parameters
    ----------
    simulator : callable
        Makes a simulator: of `certify` and `fast`.
    goals : list of ndarray, shape (n_q_a,)
        The targets of the steps, of which the last is that of all further steps, too [m, rad].
    force : float or ndarray, shape (n_v,)
        [N, N m].
    model : callable
        Makes MuJoCo's model, and its data, in which the loads are set.
    """

    simulator: Callable[..., Simulator]
    goals: list[Array]
    force: Array | float
    model: Callable[[], tuple[Any, Any]]


def boxes(count: int) -> Scene:
    """Boxes in a row on a floor each pushed for itself; none can touch another."""
    places = [(GAP * i, 0.0, HALF) for i in range(count)]
    box = Box((HALF, HALF, HALF))
    system = System([Body.of_shape(f"box{i}", box, MASS, xyz=at) for i, at in enumerate(places)])
    floor = world_plane()
    pairs = [
        ContactPair(f"f{i}", floor, on_link(system, f"box{i}/solid", box), MU_V, MU_OMEGA, 6, 4)
        for i in range(count)
    ]
    force = np.zeros(system.n_v)
    force.reshape(count, 6)[:, :3] = PUSH

    def model() -> tuple[Any, Any]:
        mujoco: Any = import_module("mujoco")
        bodies = "".join(
            f'<body pos="{words(at)}"><freejoint/>'
            f'<geom type="box" size="{words([HALF] * 3)}" mass="{MASS}"/></body>'
            for at in places
        )
        made = mujoco.MjModel.from_xml_string(
            f'<mujoco><option timestep="{H}" cone="pyramidal"/>'
            f'<default><geom condim="4" friction="{MU_V} {MU_OMEGA} 0.001"/></default>'
            f'<worldbody><geom type="plane" size="0 0 1"/>{bodies}</worldbody></mujoco>'
        )
        data = mujoco.MjData(made)
        data.xfrc_applied[1:, :3] = PUSH
        return made, data

    def simulator(certify: str, fast: bool) -> Simulator:
        K_q = np.zeros((0, 0))
        return Simulator(system, pairs, h=H, K_q=K_q, certify=certify, fast=fast)

    return Scene(simulator, [np.zeros(0)], force, model)


def hand() -> Scene:
    """The scenario of a hand that turns a drum, once its fingers are on it."""
    scenario = load_scenario("allegro_turn", ["record=light"])

    def simulator(certify: str, fast: bool) -> Simulator:
        settings = [f"solver.certify={certify}", "record=light"]
        return load_scenario("allegro_turn", settings, fast=fast).simulator()

    goals = [scenario.targets(scenario.h * (k + 1)) for k in range(scenario.steps)]
    return Scene(simulator, goals, 0.0, partial(hand_model, scenario.system, goals[50]))


def hand_model(system: System, goal: Array) -> tuple[Any, Any]:
    """MuJoCo's model of the hand, held at a goal (n_q_a,) [rad], and of the drum."""
    mujoco: Any = import_module("mujoco")
    hand = Path(system.bodies[0].urdf).read_text("utf-8")
    text = re.sub("<visual>.*?</visual>", "", hand, flags=re.DOTALL)
    spec = mujoco.MjSpec.from_string(text)
    spec.compiler.balanceinertia = True
    spec.option.timestep = H
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = int(geom.type == mujoco.mjtGeom.mjGEOM_SPHERE)
    for joint in spec.joints:
        spec.add_actuator(
            target=joint.name, trntype=mujoco.mjtTrn.mjTRN_JOINT, gainprm=[2.0, *[0.0] * 9],
            biastype=mujoco.mjtBias.mjBIAS_AFFINE, biasprm=[0.0, -2.0, -0.1, *[0.0] * 7],
        )  # fmt: skip
    drum = spec.worldbody.add_body(pos=[0.055, 0.0, 0.0525])
    drum.add_joint(type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0.0, 1.0, 0.0])
    drum.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=[0.03, 0.08, 0.0], mass=0.2,
        quat=[np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0],
    )  # fmt: skip
    made = spec.compile()
    data = mujoco.MjData(made)
    places = {joint.name.removeprefix("hand/"): joint.q for joint in system.joints}
    for i in range(made.nu):  # an actuator for each joint of the hand, in order
        place = places[made.joint(i).name]
        data.ctrl[i] = data.qpos[i] = goal[place].item()
    return made, data


class _Run:
    """A simulator that is stepped along its scene, each step from where the last one ended."""

    def __init__(self, scene: Scene, certify: str, fast: bool = True, forces: bool = False) -> None:
        self.scene = scene
        self.simulator = scene.simulator(certify, fast)
        self.forces = forces
        self.q = self.simulator.system.q_start
        self.k = 0
        self.step()

    def step(self) -> None:
        goal = self.scene.goals[min(self.k, len(self.scene.goals) - 1)]
        result = self.simulator.step(self.q, goal, self.scene.force)
        self.q = result.q
        self.k += 1
        if self.forces:
            assert len(result.forces) > 0


def costs(scene: Scene, steps: int, repeat: int) -> dict[str, Any]:
    """Medians of a step with each certificate, and of what it is compared with [us]; ratios [-].

    Parameters
    ----------
    scene : Scene
    steps : int
        That are measured; a tenth of that on the plain path.
    repeat : int
        Number of runs from the scene's start; of each step the least time is kept. The plain path
        has one run.
    """
    times = least(in_turn([_uncertified(scene)] * steps) for _ in range(repeat))
    certified = least(in_turn([_certified(scene)] * steps) for _ in range(repeat))
    slow = {FORCES: _Run(scene, PROVED, forces=True).step, PLAIN: _Run(scene, PROVED, False).step}
    rarely = in_turn([slow] * max(2, steps // 10), clock=time.thread_time)
    each = {**certified, **times, **rarely}.items()
    found: dict[str, Any] = {name: microseconds(taken) for name, taken in each}
    found["over_solver"] = ratio(times[UNCERTIFIED], times[SOLVER])
    found["proved_over_off"] = ratio(certified[PROVED], certified[UNCERTIFIED])
    if MUJOCO in times:
        found["over_mujoco"] = ratio(times[UNCERTIFIED], times[MUJOCO])
        found["solver_over_mujoco"] = ratio(times[SOLVER], times[MUJOCO])
    return found


def _uncertified(scene: Scene) -> dict[str, Job]:
    """Uncertified steps from the scene's start, the bare solver, and MuJoCo where it is there."""
    off = _Run(scene, UNCERTIFIED)
    solver: Any = off.simulator.solver
    program = solver.program
    if isinstance(program, SparseProgram):
        program = Program(program.H.toarray(), program.f, program.A.toarray(), program.b)
    jobs: dict[str, Job] = {UNCERTIFIED: off.step, SOLVER: bare_daqp(program)}
    if find_spec("mujoco") is not None:
        mujoco: Any = import_module("mujoco")
        jobs[MUJOCO] = partial(mujoco.mj_step, *scene.model())
    return jobs


def _certified(scene: Scene) -> dict[str, Job]:
    """Steps from the scene's start with each certificate."""
    return {kind: _Run(scene, kind).step for kind in (UNCERTIFIED, "residual", PROVED)}


SCENES: dict[str, Callable[[], Scene]] = {
    "1 box": lambda: boxes(1),
    "5 boxes": lambda: boxes(5),
    "25 boxes": lambda: boxes(25),
    HAND: hand,
}


def solid_scenes(names: Sequence[str], steps: int, repeat: int) -> dict[str, dict[str, Any]]:
    """What :func:`costs` gives for scenes of these names; the hand where its model is there."""
    found = {}
    for name in names:
        with suppress(ScenarioError):  # the robots are not installed
            found[name] = costs(SCENES[name](), steps, repeat)
    return found
