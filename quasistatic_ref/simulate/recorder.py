"""Steps as they are taken, collected into a trajectory."""

from __future__ import annotations

import time
from array import array
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import takewhile, zip_longest
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from quasistatic_ref.errors import InputError, check_kind
from quasistatic_ref.numbers.arrays import Array, read_only, with_shape
from quasistatic_ref.parts import is_there, part
from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.simulate.record.block import Block
from quasistatic_ref.simulate.record.header import RECORDS, Header, Record
from quasistatic_ref.simulate.record.table import (
    ARRAYS,
    FULL,
    arrays_of,
    names_of,
    no_steps,
)
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.simulate.result import StepArrays, StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.simulate.target import Drives, JointTrack, Targets
from quasistatic_ref.simulate.user_functions import Target
from quasistatic_ref.step.solution import UNKNOWN

PACKED = 100
"""Steps that are kept one by one before they become arrays, all at once."""
POINTS = ("phi", "alpha", "beta", "n", "point")
LARGEST = 1_000_000
"""Most entries of J in a step of a full record; and most, beyond those of one step, that are kept
before they become arrays."""
WatchingDoctor = Callable[[bool, Sequence[str]], Observer]
"""Whether to print findings, and names that are not printed -> the observer that notes a run's
scene, and finds at its end."""
SECONDS = "seconds."
"""What the names of wall times begin with."""


def doctors(printed: bool = False, ignore: Sequence[str] = ()) -> list[Observer]:
    """The observer of ``optional/doctor``, if that is there.

    Parameters
    ----------
    printed : bool
        Whether to print what is found.
    ignore : sequence of str
        Names of findings that are not printed.
    """
    if not is_there("doctor"):
        return []
    doctor: WatchingDoctor = part("doctor")
    return [doctor(printed, ignore)]


class Recorder:
    """Collects the results of steps into a trajectory.

    Parameters
    ----------
    simulator : Simulator
        What takes the steps.
    q : ndarray, shape (n_q,)
        Where the run starts; quaternions are normalised.
    record : str
        ``"full"``; ``"light"`` to leave out the quadratic programs; ``"forces"`` to have the forces
        of single contacts in their place.
    observers : sequence of Observer, optional
        What watches the run; by default the doctor, if it is there.
    target : callable, ndarray or mapping, optional
        What the targets follow, as :func:`~quasistatic_ref.simulate.rollout.rollout` takes it: the
        findings ask for its waypoints.

    Attributes
    ----------
    simulator : Simulator
    observers : list of Observer
    steps : int
        Number of steps so far.
    start, q : ndarray, shape (n_q,)
        Where the run started, and where it is.
    parts : list of dict
        The steps so far as arrays, but for those since the last :meth:`flush`.

    Raises
    ------
    InputError
        If there is no such record, or q is no configuration.

    Examples
    --------
    >>> scenario = qr.load_scenario("sphere_spin")
    >>> simulator, q = scenario.simulator(), scenario.system.q_start
    >>> recorder = qr.Recorder(simulator, q)
    >>> recorder.add(np.zeros(0), simulator.step(q))
    >>> recorder.trajectory().steps
    1
    """

    def __init__(
        self,
        simulator: Simulator,
        q: ArrayLike,
        record: Record = "full",
        observers: Sequence[Observer] | None = None,
        target: Target | None = None,
    ) -> None:
        check_kind(simulator, Simulator, "simulator", "a Simulator")
        if record not in RECORDS:
            raise InputError(f"must be one of {', '.join(RECORDS)}", field="record", value=record)
        if record == "forces":
            part("contact_forces", 'record = "forces"')
        entries = 4 * len(simulator.plan.layout.names) * simulator.system.n_v
        if record == FULL and entries > LARGEST:
            problem = (
                f"of steps whose J has {entries} entries, more than {LARGEST}, takes too much "
                'room; say record = "light"'
            )
            raise InputError(problem, field="record", value=record)
        self.simulator = simulator
        self.system = simulator.system
        self.record = record
        watch = doctors() if observers is None else observers
        check_kind(watch, Iterable, "observers", "a list of Observer")
        self.observers = list(watch)
        for observer in self.observers:
            check_kind(observer, Observer, "observers", "a list of Observer")
        self.start = self.system.checked(q)
        self.q = self.start
        self.steps = 0
        self.tracks: Sequence[JointTrack] = target.tracks if isinstance(target, Targets) else ()
        self.idle_columns: Sequence[str] = target.idle if isinstance(target, Drives) else ()
        self.extra: tuple[str, ...] = ()
        self.with_cost: bool | None = None
        self.alone = True
        self.unanswered: list[int] = []
        self.parts: list[StepArrays] = []
        self._latest: list[StepResult] = []
        self._targets: list[Array] = []
        self._between = array("d")
        self._since = time.perf_counter()

    @property
    def t(self) -> float:
        """End of the step that comes next [s]."""
        return (self.steps + 1) * self.simulator.h

    def add(self, q_bar_a: ArrayLike, result: StepResult) -> None:
        """Record one step that succeeded.

        Parameters
        ----------
        q_bar_a : array_like, shape (n_q_a,)
            Its target.
        result : StepResult

        Raises
        ------
        InputError
            If the target has another shape, the record holds forces and they are not known, an
            extension's rows are not those of the step before, or one of the two alone has a
            quadratic cost.
        """
        check_kind(result, StepResult, "result", "a StepResult, as step returns it")
        target = with_shape(q_bar_a, "q_a", (self.system.n_q_a,), InputError)
        self._check(result)
        if result.solution.statistics.unanswered:
            self.unanswered.append(self.steps)
        self.q = read_only(result.q)  # a function of (t, q) cannot change where it starts
        self._latest.append(result)
        self._targets.append(target.copy())
        self.steps += 1
        contacts = result.step.contacts
        most = min(PACKED, 1 + LARGEST // max(1, 4 * contacts.n_c * contacts.n_v))
        if len(self._latest) >= most or any(each.every_step for each in self.observers):
            self.flush()
        now = time.perf_counter()
        self._between.append(now - self._since - sum(result.seconds.values()))
        self._since = now

    def _check(self, result: StepResult) -> None:
        """Refuse a result that does not belong to this run; errors as of :meth:`add`."""
        rows = result.step.extra.names
        if self.steps and rows != self.extra:
            pairs = zip_longest(self.extra, rows, fillvalue="no row")
            was, now = next((was, now) for was, now in pairs if was != now)
            problem = f"has {now} in step {self.steps}, where the step before has {was}; "
            raise InputError(problem + "give the same rows in each step", field="extension")
        with_cost = result.step.extra.cost is not None
        if self.with_cost not in (None, with_cost):
            has, had = ("a", "none") if with_cost else ("no", "one")
            problem = f"has {has} quadratic cost in step {self.steps}, the step before has {had}; "
            raise InputError(problem + "give one in each step, of weight 0", field="extension")
        if self.record == "forces" and not result.solution.alone:
            raise InputError(UNKNOWN, field="forces")
        self.alone &= result.solution.alone
        self.extra = rows
        self.with_cost = with_cost

    def flush(self) -> None:
        """Collect the steps since the last flush into arrays, and pass them to the observers.

        Steps of which something cannot be known are dropped: the run ends before them.
        """
        results = self._latest
        if not results:
            return
        try:
            arrays, every = self._arrays(results)
        except BaseException:
            self.steps -= len(results)
            self.q = self.parts[-1]["q"][-1] if self.parts else self.start
            raise
        finally:
            self._latest = []
            self._targets = []
        for kept in (*arrays.values(), *every.values()):
            read_only(kept)
        before = self.parts[-1] if self.parts else arrays
        self.parts.append(arrays)  # before an observer may raise
        for observer in self.observers:
            notes = observer.after(self, results, StepArrays(every | arrays))
            for name, note in notes.items():
                arrays[name] = _checked_note(name, note, len(results), before.get(name))

    def _arrays(self, results: Sequence[StepResult]) -> tuple[StepArrays, StepArrays]:
        """Arrays of the last steps for the trajectory, and those for the observers."""
        block = Block(results, self.system.n_v)
        law, rows, cost = self.simulator.law, bool(self.extra), bool(self.with_cost)
        arrays = StepArrays({
            "t": np.arange(self.steps - len(results) + 1, self.steps + 1) * results[0].step.h,
            "q_bar_a": np.array(self._targets),
            "q": block.of_each("q"),
            "tau": block.tau,
            **arrays_of(block, names_of(self.record, law, rows, cost)),
        })  # fmt: skip
        for name in results[0].seconds:
            arrays[SECONDS + name] = np.array([result.seconds[name] for result in results])
        asked = [] if "motion" in arrays or not self.observers else ["motion"]
        return arrays, arrays_of(block, asked)

    @property
    def notes(self) -> tuple[str, ...]:
        """Names of the arrays that observers keep."""
        return tuple(name for observer in self.observers for name in observer.notes)

    def noted(self, name: str) -> NDArray[Any]:
        """The numbers that an observer kept of each step, shape (steps, ...) [any unit].

        Without the last steps, while it is asked about them, and after it has failed there.
        """
        self.flush()
        parts = self.parts
        if name in self.notes:
            parts = list(takewhile(lambda part: name in part, parts))
        return _over_all_steps(parts, name) if parts else np.zeros(0)

    def trajectory(self, failed: str | None = None, interrupted: bool = False) -> Trajectory:
        """Everything recorded so far, as the observers leave it.

        Parameters
        ----------
        failed : str, optional
            Why the run ended early.
        interrupted : bool
            Whether that was Ctrl-C.
        """
        self.flush()
        parts = self.parts
        kept = parts[0] if parts else {}
        simulator = self.simulator
        layout = simulator.plan.layout
        header = Header(
            h=simulator.h,
            backend=simulator.backend,
            cone=simulator.cone,
            record=self.record,
            n_a=self.system.n_a,
            n_u=self.system.n_u,
            coordinates=tuple(c.name for c in self.system.coordinates),
            units=tuple(c.unit for c in self.system.coordinates),
            positions=tuple(p.heading for joint in self.system.joints for p in joint.positions),
            slots=tuple(layout.slots),
            steps=self.steps,
            extra=self.extra,
            failed=failed,
            quasi_dynamic_number=None,  # the observers know
            largest_boundary_layer=None,
            contacts=self._contact_names() if self.record == FULL else (),
            findings=(),
            law=simulator.law,
            distances=simulator.distances,
            alone=self.alone,
            unanswered=tuple(step for step in self.unanswered if step < self.steps),
        )
        q = np.concatenate([self.start[None], *(part["q"] for part in parts)])
        arrays = {name: _over_all_steps(parts, name) for name in kept if name in ARRAYS}
        arrays = arrays or no_steps(header, layout.rows, self.system.n_q_a)
        constant = {name: getattr(layout, name) for name in ("mu_v", "mu_omega", "rows")}
        arrays |= {"q": q + 0.0, **constant}
        arrays = {name: arrays[name] for name in ARRAYS if name in arrays}
        timed = [name for name in kept if name.startswith(SECONDS)]
        seconds = {name.removeprefix(SECONDS): _over_all_steps(parts, name) for name in timed}
        trajectory = Trajectory(header, arrays, seconds, simulator)
        for observer in self.observers:
            trajectory = observer.end(self, trajectory, interrupted)
        return replace(trajectory, seconds={**seconds, **self._seconds_of_run()})

    def _contact_names(self) -> tuple[tuple[str, ...], ...]:
        """Names of the contacts in each step."""
        points = [point for part in self.parts for point in part["point"]]
        return tuple(map(tuple, map(self.simulator.plan.layout.contact_names, points)))

    def _seconds_of_run(self) -> dict[str, Array]:
        """What a run takes beyond its steps, step by step, shape (steps,) [s]; its end at the last.

        With the parts of steps it adds up to the wall time since this recorder was made.
        """
        if not self.steps:
            return {}
        between = np.zeros(self.steps)
        known = self._between[: self.steps]
        between[: len(known)] = known
        end = np.zeros(self.steps)
        end[-1] = time.perf_counter() - self._since
        return {"record": between, "findings": end}


def _checked_note(name: str, note: ArrayLike, steps: int, before: Array | None) -> Array:
    """An observer's note on some steps, shape (steps, ...), if it fits its earlier notes.

    Raises
    ------
    InputError
    """
    if name in (*ARRAYS, "tau") or name.startswith(SECONDS):
        raise InputError(
            "is a name that the recording uses itself; take another", field=f"note {name}"
        )
    try:
        array = np.array(note, np.float64)
    except (TypeError, ValueError):
        array = np.zeros(())
    if array.shape[:1] != (steps,):
        problem = f"must be an array of {steps} rows of numbers, one for each of the results"
        raise InputError(problem, field=f"note {name}", value=note)
    if before is not None and array.shape[1:] != before.shape[1:]:
        problem = f"must have shape {before.shape[1:]} in each step, as in those before"
        raise InputError(problem, field=f"note {name}", value=array.shape[1:])
    return read_only(array)


def _over_all_steps(parts: list[StepArrays], key: str) -> NDArray[Any]:
    """One array of all steps, in which zero is 0.0, never -0.0."""
    array = np.concatenate([part[key] for part in parts])
    if array.dtype == np.float64:
        array += 0.0
    return array
