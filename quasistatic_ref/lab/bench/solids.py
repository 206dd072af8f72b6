"""What steps of scenes of solids cost: proved over not, first over later, and over MuJoCo's."""

import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from quasistatic_ref.errors import ScenarioError
from quasistatic_ref.lab.bench.grasp import bare_daqp
from quasistatic_ref.lab.bench.scenes import HAND, PUSHES, Scene, bin_of_boxes, cubes, hand, heap
from quasistatic_ref.lab.bench.timing import Job, in_turn, least, microseconds, ratio
from quasistatic_ref.optional.fast.adapters.program import Program, SparseProgram
from quasistatic_ref.step.data import Array

FORCES = "full, forces"
UNCERTIFIED = "off"
PROVED = "full"
PLAIN = "full, plain"
FIRST = "first"
MUJOCO = "MuJoCo"
SOLVER = "DAQP alone"
COLUMNS = (UNCERTIFIED, "residual", PROVED, FORCES, FIRST, PLAIN, SOLVER, MUJOCO)

STATES = {
    f"{n} cube{'s' * (n > 1)}, {rows} rows, {push}": partial(cubes, n, 1, rows, push)
    for rows in (4, 6)
    for n in (1, 5, 25)
    for push in [*PUSHES][:3]
}
"""Single cubes, as bodies usually are: many numbers of their steps are exactly zero."""

SCENES: dict[str, Callable[[], Scene]] = {
    **STATES,
    "stack of 10 at rest": partial(cubes, 1, 10, 6, "rest"),
    HAND: hand,
}

LARGE: dict[str, Callable[[], Scene]] = {
    **{f"{n} cubes, askew": partial(cubes, n, 1, 6, "askew") for n in (10, 40, 100, 200)},
    **{f"{n} stacks of five, rest": partial(cubes, n, 5, 6, "rest") for n in (8, 40)},
    "24 boxes in a bin": bin_of_boxes,
    "heap of 100": heap,
}
"""Of these forces, the plain path and DAQP alone are not measured: that would take minutes."""

FIRSTS = 5
"""First steps of new simulators."""


class _Run:
    """A simulator that is stepped along its scene, each step from where the last one ended."""

    def __init__(self, scene: Scene, certify: str, fast: bool = True, forces: bool = False) -> None:
        self.scene = scene
        self.simulator = scene.simulator(certify, fast)
        self.forces = forces
        self.q = scene.q
        self.k = 0
        self.step()

    def step(self) -> None:
        goal = self.scene.goals[min(self.k, len(self.scene.goals) - 1)]
        result = self.simulator.step(self.q, goal, self.scene.force)
        self.q = result.q
        self.k += 1
        if self.forces:
            assert len(result.forces) > 0


def costs(scene: Scene, steps: int, repeat: int, *, large: bool = False) -> dict[str, Any]:
    """Medians of a step with each certificate, and of what it is compared with [us]; ratios [-].

    Parameters
    ----------
    scene : Scene
    steps : int
        That are measured; a tenth of that with forces, and on the plain path.
    repeat : int
        Number of runs from the scene's start; of each step the least time is kept. Forces and the
        plain path have one run.
    large : bool
        Leaves out forces, the plain path and DAQP alone.
    """
    times = least(in_turn([_uncertified_jobs(scene, large)] * steps) for _ in range(repeat))
    certified = least(in_turn([_certified_jobs(scene)] * steps) for _ in range(repeat))
    each: dict[str, Array] = {**certified, **times, FIRST: first_steps(scene)}
    if not large:
        forces = _Run(scene, PROVED, forces=True)
        slow = {FORCES: forces.step, PLAIN: _Run(scene, PROVED, False).step}
        each |= in_turn([slow] * max(2, steps // 10), clock=time.thread_time)
    found: dict[str, Any] = {name: microseconds(taken) for name, taken in each.items()}
    found["proved_over_off"] = ratio(certified[PROVED], certified[UNCERTIFIED])
    found["first_over_later"] = found[FIRST] / found[PROVED]
    if SOLVER in times:
        found["over_solver"] = ratio(times[UNCERTIFIED], times[SOLVER])
    if MUJOCO in times:
        found["over_mujoco"] = ratio(times[UNCERTIFIED], times[MUJOCO])
    if SOLVER in times and MUJOCO in times:
        found["solver_over_mujoco"] = ratio(times[SOLVER], times[MUJOCO])
    return found


def first_steps(scene: Scene) -> Array:
    """Times of proved first steps, shape (FIRSTS,), that are compared with nothing [s].

    Of the processor, since each of them runs once.
    """
    jobs = []
    for _ in range(FIRSTS):
        simulator: Any = scene.simulator(PROVED, True)
        simulator.compares = False
        jobs.append({FIRST: partial(simulator.step, scene.q, scene.goals[0], scene.force)})
    return in_turn(jobs, clock=time.process_time)[FIRST]


def _uncertified_jobs(scene: Scene, large: bool) -> dict[str, Job]:
    """Uncertified steps from the scene's start, the bare solver, and MuJoCo where it is there."""
    off = _Run(scene, UNCERTIFIED)
    jobs: dict[str, Job] = {UNCERTIFIED: off.step}
    if not large:
        solver: Any = off.simulator.solver
        program = solver.program
        if isinstance(program, SparseProgram):
            program = Program(program.H.toarray(), program.f, program.A.toarray(), program.b)
        jobs[SOLVER] = bare_daqp(program)
    if find_spec("mujoco") is not None:
        jobs[MUJOCO] = _mujoco_step(*scene.model())
    return jobs


def _mujoco_step(model: Any, data: Any) -> Job:
    """A step of MuJoCo from rest: with the velocities of before, sliding cubes leave the floor."""
    mujoco: Any = import_module("mujoco")

    def step() -> None:
        mujoco.mj_step(model, data)
        data.qvel[:] = 0.0

    return step


def _certified_jobs(scene: Scene) -> dict[str, Job]:
    """Steps from the scene's start with each certificate."""
    return {kind: _Run(scene, kind).step for kind in (UNCERTIFIED, "residual", PROVED)}


def solid_scenes(
    scenes: Mapping[str, Callable[[], Scene]], steps: int, repeat: int, *, large: bool = False
) -> dict[str, dict[str, Any]]:
    """What :func:`costs` gives for some scenes; the hand where its model is there."""
    found = {}
    for name, made in scenes.items():
        with suppress(ScenarioError):  # the robots are not installed
            found[name] = costs(made(), steps, repeat, large=large)
    return found
