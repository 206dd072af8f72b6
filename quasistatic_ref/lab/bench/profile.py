"""What the parts of a step of ``bunny_grasp`` take, by backend."""

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

import numpy as np

from quasistatic_ref.files.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.solve.backends import QPSOLVERS

DAQP = "daqp"
BACKENDS = (
    "clarabel", "piqp", "osqp", *(QPSOLVERS + name for name in ("clarabel", "piqp", "osqp")), DAQP,
)  # fmt: skip
"""Two interior-point methods and operator splitting, through CVXPY and through qpsolvers; and a
dual active-set method, which `fast` calls by its own interface."""

SOLVE = ("the solver's own time", "rest of the solve")
"""The lap ``solve`` of the simulator's stopwatch, in two: what the solver itself reports; and the
program in natural units, the interface, and the answer in SI units."""

PARTS = (*SOLVE, "distances", "rows", "integrate")
"""Parts of a step. ``distances`` are those of all points, their selection and normals; ``rows`` are
J, M_u, tau, delta_q_bar_a, and A, b and g of them; ``integrate`` is the new configuration and its
kinematics."""

TURN = 10
"""Steps that one backend takes before the next one's turn: most of them find the processor's caches
as in a run of their own, and a drift of the machine's speed meets all backends alike."""

STEPS = 300
"""All of the grasp."""


class Profile(NamedTuple):
    """The parts of a step of one backend, nothing certified.

    Parameters
    ----------
    backend : str
    typical : mapping of str to float
        Median of each part over all steps [us].
    """

    backend: str
    typical: Mapping[str, float]

    @property
    def solve(self) -> float:
        """Share of the whole solve in the step [-]."""
        return sum(self.typical[part] for part in SOLVE) / sum(self.typical.values())

    @property
    def alone(self) -> float:
        """Share of the solver's own time in a step without its interface [-]."""
        solver, interface = (self.typical[part] for part in SOLVE)
        return solver / (sum(self.typical.values()) - interface)


@cache
def profiles(steps: int) -> tuple[Profile, ...]:
    """Profiles of the first `steps` of the grasp, for every backend of ``BACKENDS``."""
    runs = [_Run(name) for name in BACKENDS]
    for first in range(0, steps, TURN):
        for run in runs:
            for k in range(first, min(first + TURN, steps)):
                run.step(k)
    return tuple(run.profile() for run in runs)


class _Run:
    """A run of the grasp with one backend, and what the parts of its steps took."""

    def __init__(self, backend: str) -> None:
        self._backend = backend
        self._scenario = grasp_scenario(backend)
        self._simulator = self._scenario.simulator()
        self._q = self._scenario.system.q_start
        self._laps: list[tuple[float, ...]] = []

    def step(self, k: int) -> None:
        """Take step k."""
        target = self._scenario.targets(self._scenario.h * (k + 1))
        result = self._simulator.step(self._q, target)
        self._q = result.q
        lap = result.seconds
        solve_time = result.solution.statistics.solve_time or 0.0
        laps = (
            solve_time,
            lap["solve"] - solve_time,
            lap["distances"],
            lap["rows"],
            lap["integrate"],
        )
        self._laps.append(laps)

    def profile(self) -> Profile:
        """Median of each part."""
        medians = 1e6 * np.median(self._laps, axis=0)
        return Profile(self._backend, dict(zip(PARTS, medians.tolist(), strict=True)))


def grasp_scenario(backend: str) -> Scenario:
    """``bunny_grasp`` with `fast`, solved by a backend, nothing certified."""
    settings = (f"solver.backend={backend}", "solver.certify=off", "record=light")
    return load_scenario("bunny_grasp", settings, fast=True)
