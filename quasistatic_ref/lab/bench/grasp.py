"""The 13 x 80 step of the bunny: fast, plain, and the solver alone."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from quasistatic_ref.lab.bench.timing import Job, in_turn, least, microseconds, ratio
from quasistatic_ref.optional.fast.adapters.program import Program
from quasistatic_ref.optional.fast.native import NativeSolver
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.backends import CERTIFY, DEFAULT
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import ACCURACY

PLAIN = "full, plain"
FORCES = "full, and the forces of its contacts"
SETTINGS = ["solver.backend=daqp", "solver.certify=off", "record=light"]


@dataclass(frozen=True, eq=False)
class Places:
    """Where a run passed: what each interface starts each of its steps from.

    Parameters
    ----------
    scenario : Scenario
    q, goals : list of ndarray, shapes (n_q,) and (n_q_a,)
        Configurations, and the targets of the steps that start there [m, rad].
    """

    scenario: Scenario
    q: list[Array]
    goals: list[Array]


def places(steps: int) -> Places:
    """Configurations of a bunny_grasp run, from the closing of the grip on."""
    scenario = load_scenario("bunny_grasp", SETTINGS, fast=True)
    simulator = scenario.simulator()
    q = scenario.system.q_start
    visited = []
    goals = []
    start = min(300 - steps, 50)
    for k in range(start + steps):
        goal = scenario.targets(scenario.h * (k + 1))
        if k >= start:
            visited.append(q)
            goals.append(goal)
        q = simulator.step(q, goal).q
    return Places(scenario, visited, goals)


class GraspSteps:
    """Steps in turn with DAQP alone, and certified ones, in several parts of a run.

    A machine that is shared may be slower for seconds or minutes. Least times of several parts are
    less likely to be all from such a phase.

    Parameters
    ----------
    at : Places
    """

    def __init__(self, at: Places) -> None:
        run = _Run(at.scenario.simulator(), at)
        proved = _Run(replace(at.scenario, certify=CERTIFY[0]).simulator(), at)
        run.step(0)
        solver = run.simulator.solver
        assert isinstance(solver, NativeSolver)
        assert isinstance(solver.program, Program)
        alone = bare_daqp(solver.program)
        self.rounds: list[dict[str, Job]] = [
            {"before": partial(run.step, k - 1), "step": partial(run.step, k), "DAQP alone": alone}
            for k in range(1, len(at.q), 2)
        ]
        self.certified: list[dict[str, Job]] = [
            {"certified": partial(proved.step, k)} for k in range(len(at.q))
        ]
        self.parts: list[dict[str, Array]] = []

    def take(self, repeat: int) -> None:
        """Take all steps `repeat` times."""
        self.parts.append(in_turn(self.rounds, repeat) | in_turn(self.certified, repeat))

    def costs(self) -> dict[str, float]:
        """What the steps cost.

        Returns
        -------
        dict of str to float
            Medians of both and the 99th percentile of the second [us], the first over DAQP's call
            [-].
        """
        times = least(self.parts)
        return {
            "step": microseconds(times["step"]),
            "over_solver": ratio(times["step"], times["DAQP alone"]),
            "certified": microseconds(times["certified"]),
            "certified, p99": 1e6 * float(np.quantile(times["certified"], 0.99)),
        }


class _Run:
    """A run along the same targets: each step starts where the one before ended."""

    def __init__(self, simulator: Simulator, at: Places) -> None:
        self.at = at
        self.simulator = simulator
        self.q = at.q[0]
        self.k = 0

    def step(self, k: int) -> None:
        """Step k; from the place recorded there, if the last one was not the one before."""
        q = self.q if k == self.k else self.at.q[k]
        self.q = self.simulator.step(q, self.at.goals[k]).q
        self.k = k + 1


def certification(at: Places, repeat: int) -> Mapping[str, Any]:
    """The fast step with each certificate; with the first also plain, and with forces [us]."""
    simulators = {kind: replace(at.scenario, certify=kind).simulator() for kind in CERTIFY}
    plain = replace(at.scenario, certify=CERTIFY[0], fast=False, backend=DEFAULT)
    simulators[PLAIN] = plain.simulator()
    proved = simulators[CERTIFY[0]]
    rounds = [
        {kind: partial(simulator.step, q, g) for kind, simulator in simulators.items()}
        | {FORCES: lambda q=q, g=g: proved.step(q, g).forces}
        for q, g in zip(at.q, at.goals, strict=True)
    ]
    times = in_turn(rounds, repeat, time.thread_time)
    return {kind: microseconds(t) for kind, t in times.items()}


def bare_daqp(program: Program) -> Callable[[], Any]:
    """``daqp.solve`` with nothing around it, of the program as it stands at the time of the call.

    Parameters
    ----------
    program : Program
    """
    from daqp import solve  # here, where the grasp's scenario has been loaded, which asks for it

    m = len(program.b)
    unbounded = np.full(m, np.inf)
    sense = np.zeros(m, dtype=np.int32)
    given = (program.H, program.f, program.A, unbounded, program.b, sense)
    return partial(solve, *given, primal_tol=ACCURACY, dual_tol=ACCURACY)
