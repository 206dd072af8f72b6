"""Profiles of the step of ``bunny_grasp``: what its parts take, by backend and by distances."""

from collections.abc import Mapping
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.bench.timing import seconds
from quasistatic_ref.optional.fast.adapters.program import Adapter
from quasistatic_ref.optional.fast.simulator import FastSimulator
from quasistatic_ref.optional.fast.solver import FastSolver
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.solve.backends import DEFAULT, installed
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.step.data import Array

BACKENDS = ("clarabel", "piqp", "osqp", "daqp")
"""Two interior-point methods, operator splitting, and a dual active-set method."""

SOLVE = ("solver's call", "rest of the solve")
"""The lap ``solve`` of the simulator's stopwatch, in two. The call is that of the solver's own
interface: new data handed over, solution, its arrays copied. The rest makes the program in natural
units and the answer (SI units, checks, and the certificate where one is given)."""

PARTS = (*SOLVE, "distances", "rows", "integrate")
"""Parts of a step. ``distances`` are the closest points, their selection and normals; ``rows`` are
J, M_u, tau, delta_q_bar_a, and A, b and g of them; ``integrate`` is the new configuration and its
kinematics."""

TRACKER, BRUTE_FORCE = "tracker", "brute force"
"""Of which points the distances are: of short lists, as a simulator has it, or of all."""

CERTIFIED = "full"
UNCERTIFIED = "off"

TURN = 10
"""Steps that one backend takes before the next one's turn: most of them find the processor's caches
as in a run of their own, and a drift of the machine's speed meets all backends alike."""

STEPS = 300
"""All of the grasp."""

Microseconds = Mapping[str, float]
"""Part of ``PARTS`` -> time [us]."""


def share(times: Microseconds, *parts: str) -> float:
    """Share of some parts in the sum of all [-]."""
    return sum(times[part] for part in parts) / sum(times.values())


class Profile(NamedTuple):
    """The parts of a step of one backend.

    Parameters
    ----------
    backend, certify : str
    distances : str
        ``TRACKER`` or ``BRUTE_FORCE``.
    typical, mean : mapping of str to float
        Median and mean of each part over all steps [us].
    """

    backend: str
    certify: str
    distances: str
    typical: Microseconds
    mean: Microseconds

    @property
    def name(self) -> str:
        """Backend and distances, and whether the step is certified."""
        certified = "" if self.certify == UNCERTIFIED else " certified"
        return f"{self.backend}{certified}, {self.distances}"

    @property
    def solve(self) -> float:
        """Share of the whole solve in the typical step [-]."""
        return share(self.typical, *SOLVE)


class Profiles(NamedTuple):
    """The profiles of all backends, which took turns.

    Parameters
    ----------
    all : tuple of Profile
    gap : float
        Largest difference between tracker and brute force in a selected distance [m].
    """

    all: tuple[Profile, ...]
    gap: float

    def profile(self, backend: str, distances: str) -> Profile:
        """The one profile with these properties, nothing certified."""
        wanted = (backend, UNCERTIFIED, distances)
        return next(p for p in self.all if (p.backend, p.certify, p.distances) == wanted)


def step_profiles() -> dict[str, Any]:
    """Profiles of the steps of bunny_grasp, and how many signed distances a step evaluates."""
    scenario = grasp_scenario(DEFAULT, UNCERTIFIED)
    return {
        "profiles": profiles(STEPS),
        "all": all_distances(scenario),
        "tracked": float(tracked_distances(scenario, STEPS).mean()),
        "h": float(scenario.h),
    }


@cache
def profiles(steps: int) -> Profiles:
    """Profiles of the first `steps` of the grasp, for every backend of ``BACKENDS`` that is there.

    They are uncertified; Clarabel with a certificate is added.
    """
    names = [name for name in BACKENDS if name in installed("native")]
    runs = [_Run(name, UNCERTIFIED) for name in names] + [_Run(DEFAULT, CERTIFIED)]
    everything = every_distance(grasp_scenario(DEFAULT, UNCERTIFIED))
    brute = []
    gaps = []
    for first in range(0, steps, TURN):
        turn = range(first, min(first + TURN, steps))
        for run in runs:
            taken = [run.step(k) for k in turn]
        for q, phi in taken:  # those of the certified run
            everything.poses.move(q)
            brute.append(seconds(lambda: everything.contacts.find(everything.poses)))
            gaps.append(np.abs(everything.numbers["phi"] - phi).max())
    every = np.array(brute)
    found = [p for run in runs for p in (run.profile(TRACKER), run.profile(BRUTE_FORCE, every))]
    return Profiles(tuple(found), float(max(gaps)))


class _Run:
    """A run of the grasp with one backend, and what the parts of its steps took."""

    def __init__(self, backend: str, certify: str) -> None:
        self.backend = backend
        self.certify = certify
        self.scenario = grasp_scenario(backend, certify)
        self.simulator = compiled_simulator(self.scenario)
        self.q = self.scenario.system.q_start
        self.calls: list[float] = []
        self.laps: list[list[float]] = []
        # The solver that the simulator makes for itself, with a clock at the backend's call.
        first = self.simulator.step(self.q, self.scenario.targets(self.scenario.h))
        self.simulator.solver = solver = FastSolver(first.step, backend)
        solver.adapter = _clocked(solver.adapter, self.calls)

    def step(self, k: int) -> tuple[Array, Array]:
        """Take step k: the configuration (n_q,) where it starts, and phi (n_c,) [m] there."""
        self.calls.clear()
        q = self.q
        result = self.simulator.step(q, self.scenario.targets(self.scenario.h * (k + 1)))
        self.q, lap, call = result.q, result.seconds, sum(self.calls)
        solve = lap["solve"] + lap["proof"]
        rest = (solve - call, lap["distances"], lap["rows"], lap["integrate"])
        self.laps.append([call, *rest])
        return q, result.points.phi

    def profile(self, distances: str, brute_force: Array | None = None) -> Profile:
        """Median and mean of each part; with the times (n,) [s] of other distances, if given."""
        times = dict(zip(PARTS, 1e6 * np.array(self.laps).T, strict=True))
        if brute_force is not None:
            times["distances"] = 1e6 * brute_force
        typical = {part: float(np.median(t)) for part, t in times.items()}
        mean = {part: float(np.mean(t)) for part, t in times.items()}
        return Profile(self.backend, self.certify, distances, typical, mean)


def _clocked(adapter: type[Adapter], calls: list[float]) -> type[Adapter]:
    """The same adapter, which notes what each of its calls took [s]."""

    def reply(self: Adapter, same_H: bool, warm: bool) -> Reply:
        found: list[Reply] = []
        calls.append(seconds(lambda: found.append(adapter.reply(self, same_H, warm))))
        return found[0]

    return type(adapter.__name__, (adapter,), {"reply": reply})


def grasp_scenario(backend: str, certify: str) -> Scenario:
    """``bunny_grasp``, solved by the backend's own interface."""
    settings = (f"solver.backend={backend}", f"solver.certify={certify}", "record=light")
    return load_scenario("bunny_grasp", settings, fast=True)


def all_distances(scenario: Scenario) -> int:
    """Signed distances in a step by brute force: the points of each pair's cloud, added up."""
    shapes = [pair.beta.shape for pair in scenario.pairs]
    return sum(len(shape.points) for shape in shapes if isinstance(shape, PointCloud))


def tracked_distances(scenario: Scenario, steps: int) -> Array:
    """Signed distances that the tracker evaluates in each of the first `steps`, shape (steps,).

    Those of its lists; and where a list does not suffice, those of all points of the pair, from
    which a new one is made.
    """
    simulator = compiled_simulator(scenario)
    q = scenario.system.q_start
    total = np.zeros(1 + steps)
    for k in range(steps):
        q = simulator.step(q, scenario.targets(scenario.h * (k + 1))).q
        total[k + 1] = sum(each.number("evaluated") for each in simulator.contacts.clouds)
    return np.diff(total)


def every_distance(scenario: Scenario) -> FastSimulator:
    """A simulator whose lists are all points."""
    simulator = compiled_simulator(scenario)
    for each in simulator.contacts.clouds:
        each.put({"width": each.number("points")})
    return simulator


def compiled_simulator(scenario: Scenario) -> FastSimulator:
    """The simulator of a scenario with `fast`.

    Raises
    ------
    InputError
        If there is no compiler.
    """
    simulator = scenario.simulator()
    if not isinstance(simulator, FastSimulator):
        raise InputError("is measured where there is a compiler", field="fast")
    return simulator
