"""The 13 x 80 step of the bunny: native, through CVXPY, and the solver alone."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from quasistatic_ref.lab.study.bench.timing import Job, in_turn, least, microseconds, ratio
from quasistatic_ref.optional.fast.adapters.program import Program
from quasistatic_ref.optional.fast.native import NativeSolver
from quasistatic_ref.optional.fast.simulator import FastSimulator
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


def interfaces(at: Places, repeat: int) -> dict[str, Any]:
    """The step with DAQP natively, next to other interfaces and DAQP alone on the same program."""
    run = _Run(by_numpy(at.scenario), at)
    native = run.simulator
    through = replace(at.scenario, fast=False).simulator()
    run.step(0)  # builds the program that both solve
    solver = native.solver
    assert isinstance(solver, NativeSolver)
    assert isinstance(solver.program, Program)
    alone_call = bare_daqp(solver.program)
    # Each in turn with a step of a native run, and that after others: it then finds the caches as
    # a step of a run does, and not as CVXPY left them.
    others: dict[str, Callable[[Array, Array], Job]] = {
        "DAQP alone": lambda q, goal: alone_call,
        "step, through CVXPY": lambda q, goal: partial(through.step, q, goal),
    }
    before = min(BEFORE, len(at.q) - 1)
    medians: dict[str, float] = {}
    ratios: dict[str, float] = {}
    for name, other in others.items():
        rounds: list[dict[str, Job]] = [
            {f"before, {k - j}": partial(run.step, j) for j in range(k - before, k)}
            | {"native": partial(run.step, k), name: other(at.q[k], at.goals[k])}
            for k in range(before, len(at.q), 2)
        ]
        # The slow ones wait for their turn on a busy machine, and that is not their time.
        clock = time.perf_counter if name == "DAQP alone" else time.thread_time
        times = in_turn(rounds, repeat, clock)
        medians.setdefault("step, native", microseconds(times["native"]))
        medians[name], ratios[name] = microseconds(times[name]), ratio(times[name], times["native"])
    return {
        "microseconds": medians,
        "over_solver": 1 / ratios["DAQP alone"],
        "cvxpy_over_native": ratios["step, through CVXPY"],
    }


BEFORE = 5
"""Native steps before the one that is measured. The first after a step through CVXPY takes 1.4
times as long as in a run, the second 1.2 times, the fifth as long but for a twentieth."""


def by_numpy(scenario: Scenario) -> FastSimulator:
    """The simulator of a scenario with `fast`, all of whose steps are taken by NumPy."""
    simulator = scenario.simulator()
    assert isinstance(simulator, FastSimulator)
    simulator.compiled = None
    return simulator


class CompiledSteps:
    """Compiled steps in turn with DAQP alone, and certified ones, in several parts of a run.

    A machine that is shared may be slower for seconds or minutes. Least times of several parts are
    less likely to be all from such a phase.

    Parameters
    ----------
    at : Places
    """

    def __init__(self, at: Places) -> None:
        fast = at.scenario.simulator()
        assert isinstance(fast, FastSimulator)
        run = _Run(fast, at)
        proved = _Run(replace(at.scenario, certify=CERTIFY[0]).simulator(), at)
        run.step(0)
        solver = run.simulator.solver
        assert isinstance(solver, NativeSolver)
        assert isinstance(solver.program, Program)
        alone = bare_daqp(solver.program)
        self.compiled = fast.compiled is not None
        self.rounds: list[dict[str, Job]] = [
            {"before": partial(run.step, k - 1), "step": partial(run.step, k), "DAQP alone": alone}
            for k in range(1, len(at.q), 2)
        ]
        self.certified: list[dict[str, Job]] = [
            {"certified": partial(proved.step, k)} for k in range(len(at.q))
        ]
        self.parts: list[dict[str, Array]] = []

    def take(self, repeat: int) -> None:
        """Take all steps `repeat` times; none where nothing is compiled."""
        if self.compiled:
            self.parts.append(in_turn(self.rounds, repeat) | in_turn(self.certified, repeat))

    def found(self) -> dict[str, float] | None:
        """What the parts have come to; None where nothing is compiled.

        Returns
        -------
        dict of str to float
            Medians of both and the 99th percentile of the second [us], the first over DAQP's call
            [-].
        """
        if not self.compiled:
            return None
        times = least(self.parts)
        return {
            "step": microseconds(times["step"]),
            "over_solver": ratio(times["step"], times["DAQP alone"]),
            "certified": microseconds(times["certified"]),
            "certified, p99": 1e6 * float(np.quantile(times["certified"], 0.99)),
        }


class _Run:
    """A native run along the same targets: each step starts where the one before ended."""

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


def residual_over_off(at: Places, repeat: int) -> float:
    """A step with a bound of its error over one that claims nothing, both by NumPy [-]."""
    run = {kind: _Run(by_numpy(replace(at.scenario, certify=kind)), at) for kind in CERTIFY[1:]}
    rounds = [{kind: partial(run[kind].step, k) for kind in run} for k in range(len(at.q))]
    times = in_turn(rounds, repeat, time.thread_time)
    return ratio(times[CERTIFY[1]], times[CERTIFY[2]])


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
