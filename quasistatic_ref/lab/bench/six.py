"""Six figures of a scene, side by side: what a step takes, and a step of a whole run."""

import time
from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from typing import Final

import numpy as np

from quasistatic_ref.lab.bench.scenes import Scene, boxes, grasp
from quasistatic_ref.lab.bench.timing import Job, in_turn, microseconds
from quasistatic_ref.simulate.rollout import rollout
from quasistatic_ref.solve.backends import Certify

OFF: Final = "off"
PROVED: Final = "full"
PLAIN = "plain step"
STEP = "fast step, unproved"
PROVED_STEP = "fast step, proved"
RUN = "run, unproved"
PROVED_RUN = "run, proved"
MUJOCO = "MuJoCo's step"
FIGURES = (PLAIN, STEP, PROVED_STEP, RUN, PROVED_RUN, MUJOCO)
"""Medians of a step over turns, in processor time; and of a whole run with `fast` and a light
record the least time by the wall, over its steps [us]. The plain step is proved, as by default."""

SCENES: Mapping[str, tuple[Callable[[], Scene], int, int]] = {
    "the grasp": (grasp, 300, 3),
    "10 boxes": (partial(boxes, 10), 20, 3),
    "40 boxes": (partial(boxes, 40), 8, 2),
    "200 boxes": (partial(boxes, 200), 3, 1),
}
"""Each scene, how many of its steps are taken, and how often: of each step the least time is kept.
All of it takes a few minutes."""
TURN = 10
"""Steps that one job takes before the next one's turn, at most: most of them find the processor's
caches as in a run of their own."""
MOST_PLAIN = 7 * 40
"""Entries of q up to which the plain path is measured; CVXPY takes minutes for 200 boxes."""


class Steps:
    """The steps of a simulator along its scene, each from where the last one ended."""

    def __init__(self, scene: Scene, certify: Certify, fast: bool) -> None:
        self._scene = scene
        self._simulator = scene.simulator(certify, fast)
        self._q = scene.q
        self._k = 0

    def step(self) -> None:
        """Take the next step."""
        self._k += 1
        target = self._scene.target(self._simulator.h * self._k, self._q)
        self._q = self._simulator.step(self._q, target, self._scene.force).q


def figures(
    scene: Scene, steps: int, repeat: int, tell: Callable[[str], None] = lambda _: None
) -> dict[str, float]:
    """Times of a scene's steps and runs [us], by name; MuJoCo's where that is installed.

    Parameters
    ----------
    scene : Scene
    steps : int
        Of each run.
    repeat : int
        Number of runs; the plain path has one.
    tell : callable
        Called with what is measured next.
    """
    fast: dict[str, Certify] = {STEP: OFF, PROVED_STEP: PROVED}
    turn = min(TURN, max(1, steps // 3))
    runs: list[dict[str, Job]] = []
    for number in range(repeat):
        jobs: dict[str, Job] = {what: Steps(scene, kind, True).step for what, kind in fast.items()}
        if number == 0 and len(scene.q) <= MOST_PLAIN:
            jobs[PLAIN] = Steps(scene, PROVED, False).step
        if find_spec("mujoco") is not None:
            jobs[MUJOCO] = _mujoco_step(scene)
        runs.append({name: partial(_repeated, job, turn) for name, job in jobs.items()})
    taken = []
    for number, jobs in enumerate(runs):
        tell(f"steps, {number + 1} of {repeat}")
        taken.append(in_turn([jobs] * (steps // turn), clock=time.thread_time))
    medians = {
        name: microseconds(np.minimum.reduce([t[name] for t in taken if name in t])) / turn
        for name in runs[0]
    }
    whole: dict[str, Certify] = {RUN: OFF, PROVED_RUN: PROVED}
    for what, kind in whole.items():
        tell(what)
        medians[what] = 1e6 * min(_wall(scene, kind, steps) for _ in range(repeat)) / steps
    return {name: medians[name] for name in FIGURES if name in medians}


def _repeated(job: Job, often: int) -> None:
    for _ in range(often):
        job()


def _wall(scene: Scene, certify: Certify, steps: int) -> float:
    """Wall time of a run with its findings [s], without the making of the simulator."""
    simulator = scene.simulator(certify, True)
    start = time.perf_counter()
    run = rollout(
        simulator, scene.q, scene.target, steps,
        force=lambda t, q: scene.force, record="light", progress=False, findings=False,
    )  # fmt: skip
    len(run.findings)
    return time.perf_counter() - start


def _mujoco_step(scene: Scene) -> Job:
    """A step of MuJoCo from rest: with velocities, boxes that slide leave the floor."""
    step = import_module("mujoco").mj_step
    model, data = scene.model()

    def from_rest() -> None:
        step(model, data)
        data.qvel[:] = 0.0

    return from_rest
