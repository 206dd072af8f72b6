"""Scenes of solids whose steps are measured: boxes in ordinary states, and a hand with a drum.

Each is there for this package and for MuJoCo.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.scenes.piles import SIDE as SIDE_IN_HEAP
from quasistatic_ref.lab.scenes.piles import pile
from quasistatic_ref.lab.scenes.systems import on_link, words
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.shapes.placed_shape import Box, HalfSpace, PlacedShape
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array

GRAVITY = 9.81
"""[m/s^2]"""
MU_V = 0.5
"""[-]"""
MU_OMEGA = 0.01
"""[m]"""
H = 0.02
"""Time step [s]."""

SIDE = 0.04
"""Of a cube [m]."""
MASS = 0.2
"""Of a cube [kg]."""
APART = 0.1
"""From the middle of a cube to that of the next [m]."""
PUSHES = {"rest": (0.0, 0.0), "sticks": (0.2, 0.0), "slides": (0.7, 0.0), "askew": (0.56, 0.42)}
"""Of each lowest cube along x and y, as a share of its weight: friction holds half of it."""

DENSITY = 800.0
"""Of the boxes in the bin [kg/m^3]."""
BIN = (0.11, 0.07)
"""Half of the bin's length and width [m]."""
FALL = 40
"""Steps after which the boxes in the bin are at rest."""

HAND = "hand with a drum"
FLOOR = HalfSpace(np.array([0.0, 0.0, 1.0]), 0.0)


@dataclass(frozen=True, eq=False)
class Scene:
    """A scene for both engines.

    Parameters
    ----------
    simulator : callable
        Makes a simulator: of `certify` and `fast`.
    q : ndarray, shape (n_q,)
        Where its steps begin.
    goals : list of ndarray, shape (n_q_a,)
        The targets of the steps, of which the last is that of all further steps, too [m, rad].
    force : float or ndarray, shape (n_v,)
        [N, N m].
    model : callable
        Makes MuJoCo's model, and its data, in which q and the loads are set.
    """

    simulator: Callable[[str, bool], Simulator]
    q: Array
    goals: list[Array]
    force: Array | float
    model: Callable[[], tuple[Any, Any]]


@dataclass(frozen=True, eq=False)
class Boxes:
    """Free boxes between walls.

    Parameters
    ----------
    half : ndarray, shape (n, 3)
        Half edges [m].
    mass : ndarray, shape (n,)
        [kg].
    walls : sequence of HalfSpace
        The floor is one.
    rows : int
        Of each contact.
    """

    half: Array
    mass: Array
    walls: Sequence[HalfSpace] = (FLOOR,)
    rows: int = 6

    def system(self, xyz: Array) -> System:
        """The boxes as bodies, aligned with the axes, at xyz (n, 3) [m]."""
        each = zip(self.half.tolist(), self.mass.tolist(), xyz.tolist(), strict=True)
        return System(
            [
                Body.of_shape(f"box{i}", Box(tuple(half)), mass, xyz=tuple(at))
                for i, (half, mass, at) in enumerate(each)
            ]
        )

    def pairs(
        self, system: System, on_walls: Sequence[int], touching: Sequence[tuple[int, int]]
    ) -> list[ContactPair]:
        """Those of some boxes with each wall, and of boxes with each other; four contacts each."""
        walls = [PlacedShape.in_world(f"wall{i}", wall) for i, wall in enumerate(self.walls)]
        boxes = [
            on_link(system, f"box{i}/solid", Box(tuple(half)))
            for i, half in enumerate(self.half.tolist())
        ]
        shapes = [(wall, boxes[i]) for wall in walls for i in on_walls]
        shapes += [(boxes[i], boxes[j]) for i, j in touching]
        return [
            ContactPair(f"{alpha.name}-{beta.name}", alpha, beta, MU_V, MU_OMEGA, self.rows, 4)
            for alpha, beta in shapes
        ]

    def model(self, h: float, q: Array, force: Array) -> tuple[Any, Any]:
        """MuJoCo's, at q (7 n,) under forces (6 n,) [N, N m]."""
        mujoco: Any = import_module("mujoco")
        walls = "".join(
            f'<geom type="plane" size="0 0 1" pos="{words(wall.offset * wall.normal)}" '
            f'zaxis="{words(wall.normal)}"/>'
            for wall in self.walls
        )
        boxes = "".join(
            f'<body><freejoint/><geom type="box" size="{words(half)}" mass="{mass!r}"/></body>'
            for half, mass in zip(self.half, self.mass.tolist(), strict=True)
        )
        made = mujoco.MjModel.from_xml_string(
            f'<mujoco><option timestep="{h}" cone="pyramidal"/>'
            f'<default><geom condim="{self.rows // 2 + 1}" friction="{MU_V} {MU_OMEGA} 0.001"/>'
            f"</default><worldbody>{walls}{boxes}</worldbody></mujoco>"
        )
        data = mujoco.MjData(made)
        data.qpos[:] = q.reshape(-1, 7)[:, [0, 1, 2, 6, 3, 4, 5]].ravel()
        data.xfrc_applied[1:] = force.reshape(-1, 6)
        return made, data


def cubes(stacks: int, height: int, rows: int, push: str) -> Scene:
    """Stacks of cubes on a floor, which cannot touch each other; the lowest of each is pushed."""
    count = stacks * height
    boxes = Boxes(np.full((count, 3), SIDE / 2), np.full(count, MASS), rows=rows)
    of, level = np.divmod(np.arange(count), height)
    xyz = np.stack([APART * of, 0.0 * of, SIDE / 2 + SIDE * level], axis=1)
    system = boxes.system(xyz)
    lowest = np.flatnonzero(level == 0).tolist()
    above = [(i - 1, i) for i in range(count) if i % height]
    pairs = boxes.pairs(system, lowest, above)
    force = np.zeros((count, 6))
    force[lowest, :2] = MASS * GRAVITY * np.array(PUSHES[push])
    return _free(H, system, pairs, system.q_start, force.ravel(), boxes)


def heap() -> Scene:
    """5 x 5 x 4 boxes, each known to those below and before it by points; the first is pushed."""
    made = pile((5, 5, 4))
    own = made.simulator
    halves = np.full((made.bodies, 3), SIDE_IN_HEAP / 2)
    boxes = Boxes(halves, np.full(made.bodies, 0.5))
    return _free(own.h, own.system, own.pairs, made.q, made.force, boxes)


def bin_of_boxes() -> Scene:
    """24 boxes of random sizes, dropped into a bin without a turn, which are at rest there."""
    rng = np.random.default_rng(24)
    half = rng.uniform(0.012, 0.025, (24, 3))
    xyz = np.array(
        [
            (0.052 * x, 0.07 * y, 0.04 + 0.06 * z)
            for z in range(3)
            for y in (-0.5, 0.5)
            for x in (-1.5, -0.5, 0.5, 1.5)
        ]
    )
    walls = [FLOOR]
    for axis, far in enumerate(BIN):
        walls += [HalfSpace(sign * np.eye(3)[axis], -far) for sign in (1.0, -1.0)]
    boxes = Boxes(half, 8 * DENSITY * half.prod(axis=1), walls)
    system = boxes.system(xyz)
    pairs = boxes.pairs(system, range(24), [*combinations(range(24), 2)])
    falling = _simulator(H, system, pairs, "off", fast=True)
    q = system.q_start
    for _ in range(FALL):
        q = falling.step(q, np.zeros(0)).q
    return _free(H, system, pairs, q, np.zeros(system.n_v), boxes)


def _free(
    h: float,
    system: System,
    pairs: Sequence[ContactPair],
    q: Array,
    force: Array,
    boxes: Boxes,
) -> Scene:
    """A scene whose bodies are all free."""
    simulator = partial(_simulator, h, system, pairs)
    return Scene(simulator, q, [np.zeros(0)], force, lambda: boxes.model(h, q, force))


def _simulator(
    h: float, system: System, pairs: Sequence[ContactPair], certify: str, fast: bool
) -> Simulator:
    return Simulator(system, pairs, h=h, K_q=np.zeros((0, 0)), certify=certify, fast=fast)


def hand() -> Scene:
    """The scenario of a hand that turns a drum, once its fingers are on it."""
    scenario = load_scenario("allegro_turn", ["record=light"])

    def simulator(certify: str, fast: bool) -> Simulator:
        settings = [f"solver.certify={certify}", "record=light"]
        return load_scenario("allegro_turn", settings, fast=fast).simulator()

    goals = [scenario.targets(scenario.h * (k + 1)) for k in range(scenario.steps)]
    model = partial(hand_model, scenario.h, scenario.system, goals[50])
    return Scene(simulator, scenario.system.q_start, goals, 0.0, model)


def hand_model(h: float, system: System, goal: Array) -> tuple[Any, Any]:
    """MuJoCo's model of the hand, held at a goal (n_q_a,) [rad], and of the drum."""
    mujoco: Any = import_module("mujoco")
    hand = Path(system.bodies[0].urdf).read_text("utf-8")
    text = re.sub("<visual>.*?</visual>", "", hand, flags=re.DOTALL)
    spec = mujoco.MjSpec.from_string(text)
    spec.compiler.balanceinertia = True
    spec.option.timestep = h
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
