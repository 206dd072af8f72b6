"""The simulator of `fast`: the same steps, with their data from compiled code."""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.groups import group_step, linked
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import InputError, StepDataError
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.model.state import State
from quasistatic_ref.model.system import Kinematics, System
from quasistatic_ref.numbers.arrays import Array, without_warnings
from quasistatic_ref.optional.compiled.library import ffi, library, missing
from quasistatic_ref.optional.fast.guard import Plainly, program_is_plain
from quasistatic_ref.optional.fast.joined import JoinedStep
from quasistatic_ref.optional.fast.poses import Poses
from quasistatic_ref.optional.fast.program import NaturalProgram
from quasistatic_ref.optional.fast.solver import DAQP, FastSolver, FormedStep
from quasistatic_ref.optional.fast.steps import Steps
from quasistatic_ref.optional.fast.sums import Sums
from quasistatic_ref.simulate.distances import check_closed
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator, by_one_thread, checked_force, stopwatch
from quasistatic_ref.solve.backends import DEFAULT
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.solve.units import ScaledStep
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import StepSolution

if TYPE_CHECKING:
    from quasistatic_ref.step.extension import ExtensionOfQ

MOST: Final = 1024
"""Most coordinates of a step whose units are compared, which takes the inverse of all of H."""
DENSE_BELOW: Final = 600_000
"""Entries of J, 4 n_c n_v, of the largest group of bodies below which `fast` asks DAQP, whose
matrices are dense, where no backend is named."""

SURELY = 1 - 2.0**-40
"""Factor that covers the rounding of a sum of squares, each of which is rounded by 2^-53."""
STEPPED = ("step", "solution")
"""Methods of a simulator that are not those of its class where steps are taken sooner."""
INSTEAD = "the plain path takes the steps, with the same certified bits, later"


@cache
def say(sentence: str) -> None:
    """Print a sentence on standard error, once, and not in each of several processes."""
    if multiprocessing.parent_process() is None:
        print(f"quasistatic-ref: {sentence}", file=sys.stderr, flush=True)


def default_backend(system: System, pairs: Sequence[ContactPair], cone_name: str, law: str) -> str:
    """The backend of `fast` where none is named: DAQP, where its dense matrices are small enough.

    Parameters
    ----------
    system : System
    pairs : sequence of ContactPair
    cone_name, law : str
    """
    if missing() or not (law == CONVEX and cone(cone_name).polyhedral):
        return DEFAULT
    moves = system.column_map.moves[:, 0] > 0
    moved = [moves[pair.alpha.link] | moves[pair.beta.link] for pair in pairs]
    pair, joint = np.nonzero(np.reshape(moved, (len(pairs), moves.shape[1])))
    shape = len(pairs), system.n_v
    of_coordinate, of_pair = linked(pair, system.column_map.owner[joint], shape)
    n_c = np.array([one.n_c for one in pairs], dtype=np.int64)
    sizes = np.bincount(of_coordinate)
    entries = 4 * np.bincount(of_pair, n_c, len(sizes)) * sizes
    return DAQP if entries.max(initial=0) < DENSE_BELOW else DEFAULT


class FastSimulator(Simulator):
    """The steps of a simulator, in less time.

    Compiled code forms the closest points of clouds, J and the data of each step; those of a MuJoCo
    scene are formed as without. DAQP, the default backend, is called by its own interface and
    starts from its last answer, also with linear rows and quadratic costs of a user's own; any
    other backend is called as without. Answers are certified as without: wherever they are
    certified exactly, q, delta_q, A'lam and slacks have the same bits.

    The data of the first step, and where it leads, are compared with the simulator's, bit for bit.
    If they differ, or there is no compiled code, one sentence on standard error says so, and that
    simulator takes the steps.

    Parameters
    ----------
    simulator : Simulator

    Attributes
    ----------
    simulator : Simulator
        The same.
    by_c : bool
        Whether compiled code takes the steps.

    Raises
    ------
    InputError
        If that is no Simulator, its class takes steps of its own, or its distances are coal's.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> plain, q = scenario.simulator(), scenario.system.q_start
    >>> fast = qr.FastSimulator(plain)
    >>> bool((fast.step(q, np.zeros(0)).q == plain.step(q, np.zeros(0)).q).all())
    True
    """

    fast = True
    replaceable = (DEFAULT, DAQP)

    def __init__(self, simulator: Simulator) -> None:
        kind = type(simulator)
        if any(getattr(kind, name, None) is not getattr(Simulator, name) for name in STEPPED):
            problem = "has steps of its own, which nothing takes sooner; pass a plain simulator"
            raise InputError(problem, field="simulator", value=kind.__name__)
        check_closed(simulator.distances)
        self.simulator = simulator
        backend = simulator.backend
        if simulator.named_backend is None:
            settings = simulator.system, simulator.pairs, simulator.cone, simulator.law
            backend = default_backend(*settings)
        chosen = {"backend": backend, "extension": simulator.extension}
        super().__init__(**{**simulator.settings(), **chosen})
        self.named_backend = simulator.named_backend
        self.by_c = False
        self._own_data = kind is not Simulator
        if self._own_data:
            return
        reason = missing()
        self.by_c = reason is None
        if reason is not None:
            say(f"fast needs compiled code: {reason}; {INSTEAD}")
            return
        self._poses = Poses(self.system)
        self._steps = Steps(self, self._poses)
        self._sums = Sums(self.system, self._poses)
        links = self._poses.t
        self._origins = ffi.cast("double **", links.ctypes.data)
        self._link_count = len(links)
        self._compared = False
        self._natural: NaturalProgram | None = None
        self._surely_within = SURELY * self.limits.reach**2

    @property
    def extension(self) -> ExtensionOfQ | None:
        """The extension of the simulator: a function of q (n_q,), or None."""
        return self.simulator.extension

    @extension.setter
    def extension(self, extension: ExtensionOfQ | None) -> None:
        """Replace the extension of the simulator."""
        self.simulator.extension = extension

    @property
    def _natively(self) -> bool:
        """Whether DAQP is called by its own interface."""
        convex = self.law == CONVEX and cone(self.cone).polyhedral
        return convex and self.backend == DAQP

    def __reduce__(self) -> tuple[object, ...]:
        return FastSimulator, (self.simulator,)

    def step(
        self, q: ArrayLike | State, q_bar_a: ArrayLike, force: ArrayLike | None = 0.0
    ) -> StepResult:
        """Take one step, as `Simulator.step` does, and to the same bits."""
        with by_one_thread(self.system):
            if self.by_c:
                try:
                    result = self._step(q.q if isinstance(q, State) else q, q_bar_a, force)
                except StepDataError:  # the plain path says of which number
                    return self.simulator.step(q, q_bar_a, force)
                if result is not None:
                    return result
                self.by_c = False
                say(f"compiled code forms another step than the core (please report it); {INSTEAD}")
            if self._own_data:
                return super().step(q, q_bar_a, force)
            return self.simulator.step(q, q_bar_a, force)

    def _step(self, q: ArrayLike, q_bar_a: ArrayLike, force: ArrayLike | None) -> StepResult | None:
        """One step by compiled code; None if its data differ from the plain path's first step."""
        times: dict[str, float] = {}
        lap = stopwatch(times)
        change = self._sums.actuated_difference(q, q_bar_a)  # which checks both
        load = checked_force(self.system, force)
        q = np.asarray(q, np.float64)
        self._poses.move(q)
        self._steps.closest()
        lap("distances")
        formed, points = self._steps.form(change, load)
        written = self._natively and self.extension is None
        scaled = self._scaled(formed) if written else None
        if not (self._compared or self._is_plain(q, q_bar_a, load, formed, points, scaled)):
            return None
        lap("rows")
        solution = self._solution(formed, scaled, q)
        self.limits.check_penetration(formed)  # after the solve, as on the plain path
        step = solution.step
        lap("solve")
        times["proof"] = solution.statistics.proof_time
        times["solve"] -= times["proof"]
        delta_q = solution.delta_q[: self.system.n_v]
        q_next = self._sums.integrate(delta_q)
        if not self._compared:
            if bits(q_next) != bits(self.system.integrate(q, delta_q)):
                return None
            self._compared = True
        self._poses.move(q_next)
        squares = library().squared_distances(self._link_count, self._origins)
        if not squares <= self._surely_within:
            self.limits.check_reach(step, self.system.links, self._poses.kinematics().t)
        lap("integrate")
        return StepResult(q_next, step, solution, points, times, q, self)

    def _scaled(self, step: JoinedStep) -> FormedStep:
        """The step with its units, and its program written into DAQP's."""
        solver = self.solver
        natural = self._natural
        if (
            not isinstance(solver, FastSolver)
            or not natural
            or natural.program is not solver.program
        ):
            steps = self._steps
            self.solver = solver = FastSolver(steps.template, parts=steps.groups)
            self._natural = natural = NaturalProgram(steps, solver.program)
        if natural.masses is not self._steps.masses:
            without_warnings(natural.take, self._steps.masses)
        units = natural.units()
        if units is None:
            units = without_warnings(lambda: ScaledStep(step).units)
        scaled = FormedStep(step, units, natural.blocks, natural.program)
        natural.write(units)
        solver.written = scaled
        return scaled

    def _is_plain(
        self,
        q: Array,
        q_bar_a: ArrayLike,
        force: Array,
        step: StepData,
        points: ClosestPoints,
        scaled: FormedStep | None,
    ) -> bool:
        """Whether a step, group by group, and its program are those of the plain path."""
        change = self.system.actuated_difference(q, q_bar_a)
        plain = Plainly(self.simulator, q, change, force)
        if bits(points) != bits(plain.points):
            return False
        for i, group in enumerate(self._steps.groups):
            part = plain.step(group)
            if part != group_step(step, group):
                return False
            if scaled is None:
                continue
            assert self._natural is not None
            program = self._natural.program.parts[i]
            if not program_is_plain(part, scaled.units, scaled.blocks[i], program):
                return False
        # H^-1 of more is not formed: what decides on its units is in natural.c.
        if scaled is None or step.n_v > MOST:
            return True
        return ScaledStep(step).units[1:] == scaled.units[1:]

    def _solution(self, step: StepData, scaled: FormedStep | None, q: Array) -> StepSolution:
        """The solution of a step from q, (n_q,); errors as of the plain path."""
        if scaled is None:
            return self.extended(step, q)
        assert self.solver is not None  # which fits the step
        try:
            return self.solved(scaled, self.solver)
        except StepNotSolved as failure:
            return self.otherwise_solved(step, failure)

    def closest_points(self, kinematics: Kinematics) -> ClosestPoints:
        """Closest points by the plain simulator."""
        return self.simulator.closest_points(kinematics)

    def step_data(
        self,
        q: ArrayLike | State,
        q_bar_a: ArrayLike,
        force: ArrayLike | None,
        points: ClosestPoints,
    ) -> StepData:
        """The data of one step by the plain simulator."""
        return self.simulator.step_data(q, q_bar_a, force, points)

    def step_at(
        self, q: ArrayLike | State, q_bar_a: ArrayLike, tau: Array, points: ClosestPoints
    ) -> StepData:
        """The problem of one step from its closest points and all forces, (n_v,) [N, N m].

        After a first step it is formed in C: J by the columns of each contact, and M_u by bodies.
        """
        if not (self.by_c and self._compared):
            return self.simulator.step_at(q, q_bar_a, tau, points)
        here = self.system.at(q)
        with by_one_thread(self.system):
            self._poses.move(here.q)
            return self._steps.at(points, here.change_to(q_bar_a), tau)

    def fitting_solver(self, step: StepData) -> Solver:
        """The solver of the last step if it fits this step, else a new one."""
        if not self._natively:
            return super().fitting_solver(step)
        if self.solver is None or not self.solver.fits(step):
            self.solver = FastSolver(step)
        return self.solver

    def start_cold(self) -> None:
        """Forget all that answers of later steps could depend on."""
        super().start_cold()
        self.simulator.start_cold()
