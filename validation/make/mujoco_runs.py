"""Scenes of others that run: ``python -m validation.make.mujoco_runs [--folder F] [--out FILE]``.

Each of ``SCENES``, from the packages of ``validation.make.guests``, runs for 100 steps of 10 ms,
from its first keyframe if it has one. Servos follow a fifth of the range of their controls; joints
with motors alone have springs, and turn by 0.1, and so do those of a robot that MuJoCo guides by a
body with ``mocap``, which lets go. One of them, in which a robot lifts a block, begins
where MuJoCo's own simulation has brought its open fingers, and is interrupted once and resumed.
Next to each a scene of ours runs with as many coordinates and rows, within 10 %: free bodies
above a floor, or the last link of an arm, each with a dome of points. The cost of steps is compared
in turn, by the processor.
Exit status 1 if a step is not certified, the block is not lifted, or steps of more than one scene
cost three times those of ours.
"""

import copy
import sys
import tempfile
import time
import warnings
from collections import Counter
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref import (
    Body,
    ContactPair,
    HalfSpace,
    PlacedShape,
    PointCloud,
    QuasistaticError,
    Recorder,
    RunFailed,
    Simulator,
    Sphere,
    System,
    Trajectory,
)
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.optional.guests.scene import MujocoScenario, mujoco_scenario
from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.step.cones import cone
from validation.make.guests import PACKAGES, install
from validation.tools.scripts import script_options, show_page

mujoco = import_module("mujoco")
SAWYER = "metaworld/assets/sawyer_xyz"
GYM = "gymnasium_robotics/envs"
LIFT = f"{SAWYER}/sawyer_reach_push_pick_and_place.xml"
SCENES = (
    LIFT, f"{SAWYER}/sawyer_push_v3.xml", f"{SAWYER}/sawyer_dial.xml",
    "metaworld/assets/objects/soccer_ball.xml", "metaworld/assets/objects/mug.xml",
    f"{GYM}/assets/hand/reach.xml", f"{GYM}/mujoco/assets/ant.xml",
    f"{GYM}/mujoco/assets/half_cheetah.xml", f"{GYM}/mujoco/assets/walker2d.xml",
    f"{GYM}/mujoco/assets/pusher.xml", "dm_control/suite/reacher.xml",
    "dm_control/suite/finger.xml", "dm_control/suite/ball_in_cup.xml",
    "dm_control/suite/cheetah.xml", "dm_control/third_party/kinova/jaco_hand.xml",
    "robosuite/models/assets/grippers/bd_gripper.xml",
    "robosuite/models/assets/objects/door_lock.xml",
    "robosuite/models/assets/objects/door.xml", "robosuite/models/assets/robots/baxter/robot.xml",
    "myosuite/envs/myo/assets/leg_soccer/soccer_assets/soccer_scene/soccer_ball.xml",
)  # fmt: skip
AXES = int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE)
STEPS = 100
STIFF = 200.0
"""Of springs of joints with motors [N/m, N m/rad]."""
TURN, SHARE = 0.1, 0.2
"""By how much they are driven [m, rad], and servos, of the range of their controls [-]."""
HIGH = 0.08
"""By how much the block is to be lifted [m]."""
MOST = 3.0
COMPARED = 4
"""Steps of both that are compared."""
HEAD = (
    "scene", "n_v", "n_a", "places", "rows", "steps", "certified", "findings",
    "cost of a step, over ours",
)  # fmt: skip
PAGE = """# Scenes of others that run

Made by `python -m validation.make.mujoco_runs` with MuJoCo {version}, of {packages}: 100 steps of
10 ms each, with targets (what drives which is said in the script). They were chosen after
others had failed: robotiq_2f140 and panda_gripper, which start with shapes in each other, are not
among them; and how the block is grasped was tuned.

{whole} of {count} run to their end, {steps} steps, of which {exact} are exact, {enclosed} enclosed
and {residual} certified by residuals. In the first a robot grasps a block and lifts it by
{lifted:.1f} mm; that run, interrupted after 40 steps and resumed, has {bits}. A step costs
{middle:.2f} times a step of ours (median) and {worst:.2f} times at most; {cheap} of {count} cost at
most {most:g} times as much. Rows are those of contacts and of limits and equalities.

{table}
"""


@dataclass
class Ran:
    """What became of one scene; of the lifted block how far it rose [m], and equal bits."""

    path: str
    sizes: tuple[int, ...]
    steps: int
    kinds: dict[str, int]
    failed: str | None
    findings: int
    ratio: float
    rise: float = 0.0
    same: bool = True


def driven_scene(model: Any, data: Any) -> MujocoScenario:
    """A scene whose servos and joints with motors are driven."""
    stiffness = {}
    servos = set()
    for i in range(model.nu):
        if model.actuator_biasprm[i, 1] < 0:
            servos.add(i)
            continue
        j = model.actuator_trnid[i, 0]
        by_joint = int(model.actuator_trntype[i]) == int(mujoco.mjtTrn.mjTRN_JOINT)
        if by_joint and int(model.jnt_type[j]) in AXES and model.joint(j).name:
            stiffness[f"stiffness.{model.joint(j).name}"] = STIFF
    if model.nmocap:
        data.eq_active[:] = 0
        held = {int(model.actuator_trnid[i, 0]) for i in servos}
        stiffness |= {f"stiffness.{model.joint(j).name}": STIFF for j in range(model.njnt)
                      if model.joint(j).name and j not in held
                      and int(model.jnt_type[j]) in AXES}  # fmt: skip
    begin = {model.actuator(i).name or str(i): data.ctrl[i] for i in servos}
    ends = {model.actuator(i).name or str(i): model.actuator_ctrlrange[i, 1] for i in servos
            if model.actuator_ctrllimited[i]}  # fmt: skip
    joints = {name.partition(".")[2]: data.qpos[model.joint(name.partition(".")[2]).qposadr[0]]
              for name in stiffness}  # fmt: skip

    def targets(t: float) -> dict[str, float]:
        of_servos = {name: begin[name] + SHARE * t * (end - begin[name])
                     for name, end in ends.items()}  # fmt: skip
        return of_servos | {name: q + TURN * t for name, q in joints.items()}

    cone = {"cone": "pyramid"} if model.neq else {}  # the ellipsoid takes no rows of equalities
    return mujoco_scenario(model, data, targets, stiffness | cone, steps=STEPS)


def lifting_scene(model: Any) -> MujocoScenario:
    """A robot that grasps its block and lifts it, by springs of its joints.

    MuJoCo brings the hand above the block and over it by its body with ``mocap``; the joints there
    are the targets.
    """
    data = mujoco.MjData(model)
    block = int(model.jnt_qposadr[model.body("obj").jntadr[0]])
    at = data.qpos[block : block + 3].copy()
    data.ctrl[:] = -1.0, 1.0
    arm = [f"right_j{i}" for i in range(7)]
    model.eq_data[0, 3:10] = 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0  # the hand is where its guide is
    data.mocap_pos[0] = at + np.array([0.0, 0.0, 0.2])
    data.mocap_quat[0] = 1.0, 0.0, 1.0, 0.0
    for _ in range(1000):
        mujoco.mj_step(model, data)
    at = data.qpos[block : block + 3].copy()

    def brought(height: float) -> dict[str, float]:
        """Joints with the middle of both fingers so high above the block."""
        for _ in range(2000):
            middle = (data.body("rightpad").xpos + data.body("leftpad").xpos) / 2
            data.mocap_pos[0] += 0.005 * (at + np.array([0.0, 0.0, height]) - middle)
            mujoco.mj_step(model, data)
        return {name: float(data.joint(name).qpos[0]) for name in arm}

    above = brought(0.03 + HIGH)
    low = brought(0.03)
    data.qpos[block : block + 3] = at
    data.qpos[block + 3 : block + 7] = 1.0, 0.0, 0.0, 0.0
    data.eq_active[:] = 0
    data.qvel[:] = 0.0

    def targets(t: float) -> dict[str, float]:
        closed = min(t / 0.3, 1.0)
        up = float(np.clip((t - 0.35) / 0.6, 0.0, 1.0))
        hand = {"0": -1 + 2 * closed, "1": 1 - 2 * closed}
        return hand | {name: (1 - up) * low[name] + up * above[name] for name in arm}

    stiff = {f"stiffness.{name}": 1e4 for name in arm}
    return mujoco_scenario(model, data, targets, stiff | {"cone": "pyramid"}, steps=STEPS)


def like(scene: MujocoScenario, rows: int) -> tuple[Simulator, Any]:
    """A scene of ours with as many coordinates and about as many rows, and where it starts.

    Joint friction appends a coordinate each.
    """
    n_v = scene.system.n_v + len(scene.of_mujoco.rises)
    free = (n_v - 1) // 6
    arm = n_v - 6 * free
    k = max(1, round(rows / 4 / max(1, free)))
    dome = [[0.05 * np.sin(a) * np.cos(2.4 * i), 0.05 * np.sin(a) * np.sin(2.4 * i),
             -0.05 * np.cos(a)] for i, a in enumerate(np.linspace(0, 1, k))]  # fmt: skip
    links = "".join(
        f'<link name="l{i}"><inertial><mass value="1"/><inertia ixx=".01" iyy=".01" izz=".01" '
        'ixy="0" ixz="0" iyz="0"/></inertial></link>' for i in range(arm + 1)
    )  # fmt: skip
    joints = "".join(
        f'<joint name="j{i}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/>'
        '<axis xyz="0 1 0"/><limit effort="1" velocity="1" lower="-1" upper="1"/></joint>'
        for i in range(arm)
    )
    bodies = [Body(f"b{i}", ball(), "floating", xyz=(i, 0, 0.05)) for i in range(free)]
    robot = f'<robot name="arm">{links}{joints}</robot>'
    system = System([Body("arm", robot, actuated="all", xyz=(0, 0, 1)), *bodies] if arm else bodies)
    floor = PlacedShape.in_world("floor", HalfSpace((0.0, 0.0, 1.0), 0.0))
    touching = [f"b{i}" for i in range(free)] or [f"arm/l{arm}"]
    pairs = [
        ContactPair(
            f"p{i}", floor,
            PlacedShape(f"c{i}", system.link(link), np.eye(3), np.zeros(3),
                        PointCloud(np.array(dome))),
            mu_v=0.5, mu_omega=0.0, rows=4, k=k,
        )
        for i, link in enumerate(touching)
    ]  # fmt: skip
    return Simulator(system, pairs, h=0.01, K_q=STIFF if arm else np.zeros((0, 0))), system.q_start


def ball() -> str:
    """The URDF of a ball of 5 cm."""
    return str(Body.of_shape("ball", Sphere(0.05), 0.3).urdf)


def cost(simulator: Any, q: Any, target: Any, force: Any) -> float:
    """Time of the processor for a step, the mean of ``COMPARED`` after the first [s]."""
    begin = 0.0
    for k in range(COMPARED + 1):
        if k == 1:
            begin = time.process_time()
        t = (k + 1) * simulator.h
        q = simulator.step(q, target(t, q), force(t, q)).q
    return (time.process_time() - begin) / COMPARED


def ratio(scene: MujocoScenario, rows: int) -> float:
    """What a step costs, over one of ours with as many coordinates and rows: the median of 3."""
    found = []
    for _ in range(3):
        simulator, q = like(scene, rows)
        held = q[: simulator.system.n_q_a]
        ours = cost(simulator, q, lambda t, q, held=held: held, lambda t, q: 0.0)
        theirs = cost(scene.simulator(), scene.system.q_start, scene.targets, scene.force)
        found.append(theirs / ours)
    return float(np.median(found))


class Stop(Observer):
    """Ctrl-C after 40 steps, once."""

    def before(self, recorder: Recorder) -> None:
        """Interrupt."""
        if recorder.steps == 40:
            raise KeyboardInterrupt


def same_after_resuming(scene: MujocoScenario, run: Trajectory) -> bool:
    """Whether the run, interrupted and resumed, has the same bits."""
    with tempfile.TemporaryDirectory() as folder:
        saving = {"save": Path(folder) / "run.npz", "save_every": 0.0}
        try:
            scene.run(progress=False, observers=[Stop()], **saving)
        except RunFailed:
            again = scene.run(progress=False, resume=True, **saving)
    return all(np.array_equal(run[name], again[name]) for name in ("q", "lam", "phi", "delta_q"))


def run_record(path: str, folder: Path) -> Ran:
    """A scene, run."""
    model = mujoco.MjModel.from_xml_path(str(folder / path))
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    scene = lifting_scene(model) if path == LIFT else driven_scene(model, copy.copy(data))
    try:
        run = scene.run(progress=False)
    except RunFailed as failed:
        run = failed.trajectory
    rows = rows_of(scene)
    system = scene.of_mujoco
    found = Ran(
        path,
        (system.n_v, system.n_a, int(system.places.counts.sum()), rows),
        run.steps,
        Counter(map(str, run["certificate"])),
        run.failed,
        len(run.findings),
        ratio(scene, rows),
    )
    if path == LIFT:
        height = system.of(run["q"], "obj.z")
        found.rise = float(height[-1] - height[0])
        found.same = same_after_resuming(scene, run)
    return found


def rows_of(scene: MujocoScenario) -> int:
    """Rows of its step: those of contacts, limits, equalities and joint friction."""
    per_pair = cone(scene.cone).counts(np.array([pair.rows for pair in scene.pairs], dtype=int))
    contacts = int(per_pair @ scene.of_mujoco.places.counts) if len(scene.pairs) else 0
    return contacts + len(scene.of_mujoco.rows.names) + 2 * len(scene.of_mujoco.rises)


def page(every: list[Ran]) -> str:
    """The committed page."""
    table = [
        (r.path, *r.sizes, r.steps,
         ", ".join(f"{n} {kind}" for kind, n in sorted(r.kinds.items()))
         + (f"; {r.failed}" if r.failed else ""), r.findings, f"{r.ratio:.2f}")
        for r in every
    ]  # fmt: skip
    kinds = sum((Counter(r.kinds) for r in every), Counter[str]())
    ratios = [r.ratio for r in every]
    return PAGE.format(
        version=mujoco.__version__,
        packages=", ".join(PACKAGES),
        count=len(every),
        whole=sum(r.failed is None for r in every),
        steps=sum(r.steps for r in every),
        exact=kinds["exact"],
        enclosed=kinds["enclosure"],
        residual=kinds["residual"],
        lifted=1e3 * max(r.rise for r in every),
        bits="the same bits" if all(r.same for r in every) else "other bits",
        middle=float(np.median(ratios)),
        worst=max(ratios),
        cheap=sum(x <= MOST for x in ratios),
        most=MOST,
        table="\n".join(markdown_table(HEAD, table, 1)),
    )


def main() -> int:
    """Run all scenes, write the page, and return the exit status."""
    options = script_options(__doc__, SCENES, folder=Path, out=Path)
    mujoco.set_mju_user_warning(lambda text: None)
    with tempfile.TemporaryDirectory() as own, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # MuJoCo's, of what is deprecated
        folder = options.folder or Path(own)
        install(folder)
        every = [run_record(path, folder) for path in options.names or SCENES]
    show_page(page(every), options.out)
    good = all(r.failed is None and not r.kinds.get("none") and r.same for r in every)
    dear = sum(r.ratio > MOST for r in every)
    lifted = all(r.rise > HIGH / 2 for r in every if r.path == LIFT)
    return int(not (good and lifted) or dear > 1)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except QuasistaticError as error:
        sys.exit(str(error))
