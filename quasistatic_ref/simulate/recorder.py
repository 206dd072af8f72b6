"""Steps as they are taken, collected into a trajectory."""

from __future__ import annotations

import time
from array import array
from collections.abc import Sequence
from dataclasses import replace
from itertools import takewhile, zip_longest
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.certify.solution import UNKNOWN
from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array, read_only
from quasistatic_ref.parts import check_there, doctors
from quasistatic_ref.simulate.header import RECORDS, Header, Record
from quasistatic_ref.simulate.law import COULOMB, ITERATED
from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.simulate.record import (
    CONSTANT,
    COST,
    EXTRA,
    FORCES,
    LARGEST,
    LOADS,
    PER_STEP,
    PROGRAM,
)
from quasistatic_ref.simulate.result import StepArrays, StepResult
from quasistatic_ref.simulate.target import Drives, JointTrack, Targets
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import standard_form

if TYPE_CHECKING:
    from quasistatic_ref.simulate.simulator import Simulator
    from quasistatic_ref.simulate.user_functions import Target

PACKED = 100
"""Steps that are kept one by one before they become arrays, all at once."""
POINTS = ("phi", "alpha", "beta", "n", "point")
IN_ORDER = (*PER_STEP, *PROGRAM, "column", *FORCES, *EXTRA, *COST, *ITERATED)
SECONDS = "seconds."
"""What the names of wall times begin with."""


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
    >>> recorder.add(np.zeros(0), simulator.step(q, np.zeros(0)))
    >>> len(recorder.trajectory())
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
        if record not in RECORDS:
            raise InputError(f"must be one of {', '.join(RECORDS)}", field="record", value=record)
        if record == "forces":
            check_there("forces", 'record = "forces"')
        self.simulator = simulator
        self.system = simulator.system
        self.record = record
        self.observers = list(doctors() if observers is None else observers)
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

    def add(self, q_bar_a: Array, result: StepResult) -> None:
        """Record one step that succeeded.

        Parameters
        ----------
        q_bar_a : ndarray, shape (n_q_a,)
            Its target.
        result : StepResult

        Raises
        ------
        InputError
            If the record holds forces and they are not known, or an extension's rows are not those
            of the step before, or one of the two alone has a quadratic cost.
        """
        self._check(result)
        if result.solution.statistics.unanswered:
            self.unanswered.append(self.steps)
        self.q = read_only(result.q)  # a function of (t, q) cannot change where it starts
        self._latest.append(result)
        self._targets.append(q_bar_a)
        self.steps += 1
        contacts = result.step.contacts
        most = min(PACKED, 1 + LARGEST // max(1, 4 * contacts.n_c * contacts.n_v))
        if len(self._latest) >= most or any(each.every_step for each in self.observers):
            self.flush()
        now = time.perf_counter()
        self._between.append(now - self._since - sum(result.seconds.values()))
        self._since = now

    def _check(self, result: StepResult) -> None:
        """Check a result that is added; errors as of :meth:`add`."""
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
        """Make a part of the steps since the last flush, and ask the observers about them.

        Steps of which something cannot be known are dropped: the run ends before them.
        """
        results = self._latest
        if not results:
            return
        try:
            every = arrays_of(results, self.system.n_v)
            arrays = self._arrays(results, every)
            if self.observers and "motion" not in arrays:
                every["motion"] = motions(results, self.system.n_v)
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
            notes = observer.after(self, results, every | arrays)
            for name, note in notes.items():
                arrays[name] = _checked_note(name, note, len(results), before.get(name))

    def _arrays(self, results: Sequence[StepResult], every: StepArrays) -> StepArrays:
        """What is kept of the last steps, of which `every` array is read."""
        first = results[0].step
        arrays: StepArrays = {
            "t": np.arange(self.steps - len(results) + 1, self.steps + 1) * first.h,
            "q_bar_a": np.array(self._targets),
            **every,
        }
        if self.record == "full":
            arrays |= programs([result.step for result in results])
        if self.record == "forces":
            forces_of = [_forces_of(result) for result in results]
            arrays["forces"] = np.array([forces for forces, _ in forces_of])
            arrays["imbalance"] = np.array([imbalance for _, imbalance in forces_of])
            arrays["motion"] = motions(results, self.system.n_v)
        more = ITERATED if self.simulator.law == COULOMB else ()
        if first.extra.names:
            more = (*more, "lam_extra")
        return arrays | {name: _of_all([r.solution for r in results], name) for name in more}

    @property
    def notes(self) -> tuple[str, ...]:
        """Names of what the observers keep of each step."""
        return tuple(name for observer in self.observers for name in observer.notes)

    def noted(self, name: str) -> NDArray[Any]:
        """What an observer kept of each step so far, shape (steps, ...) [any unit].

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
        known = [name for name in IN_ORDER if name in kept]
        arrays = {name: _over_all_steps(parts, name) for name in known} or {
            name: np.zeros(0) for name in ("t", "delta_q", "worst_residual")
        }
        full = self.steps and self.record == "full"
        simulator = self.simulator
        layout = simulator.layout
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
            contacts=tuple(map(tuple, map(layout.contact_names, arrays["point"]))) if full else (),
            findings=(),
            law=simulator.law,
            distances=simulator.distances,
            alone=self.alone,
            unanswered=tuple(step for step in self.unanswered if step < self.steps),
        )
        constant = {k: getattr(layout, k) if self.steps else np.zeros(0) for k in CONSTANT}
        q = np.concatenate([self.start[None], *(part["q"] for part in parts)])
        arrays = {"q": q + 0.0, **arrays, **constant}
        timed = [name for name in kept if name.startswith(SECONDS)]
        seconds = {name.removeprefix(SECONDS): _over_all_steps(parts, name) for name in timed}
        trajectory = Trajectory(header, arrays, seconds, simulator)
        for observer in self.observers:
            trajectory = observer.end(self, trajectory, interrupted)
        return replace(trajectory, seconds={**seconds, **self._seconds_of_run()})

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


def arrays_of(results: Sequence[StepResult], n_v: int) -> StepArrays:
    """What a recorder reads of steps that follow one another, but for ``motion``.

    Returns
    -------
    dict of str to ndarray, shape as in the notation, behind a first axis, the step [-]
        By the notation's names [in its units].
    """
    solutions = [result.solution for result in results]
    steps = [result.step for result in results]
    certificates = [solution.certificate for solution in solutions]
    tau_a = np.array([step.tau_a for step in steps])
    tau_u = np.array([step.tau_u for step in steps])
    tau = np.concatenate([tau_a, tau_u], axis=1)
    arrays: StepArrays = {
        "delta_q": np.array([solution.delta_q[:n_v] for solution in solutions]),
        **{name: _of_all([r.points for r in results], name) for name in POINTS},
        **{name: _of_all([step.contacts for step in steps], name) for name in ("d1", "d2")},
        "lam": _of_all(solutions, "lam")[:, : steps[0].offsets[-1]],
        "wrench": _of_all(solutions, "wrench"),
        "certificate": np.array([one.kind for one in certificates]),
        "worst_residual": np.array(
            [max(one.residuals.values(), default=np.nan) for one in certificates]
        ),
        "digits": np.array([one.statistics.digits for one in solutions], np.float64),
        "q": _of_all(results, "q"),
        "tau": tau[:, :n_v],  # without private rises
    }
    for part in results[0].seconds:
        arrays[SECONDS + part] = np.array([result.seconds[part] for result in results])
    return arrays


def _forces_of(result: StepResult) -> tuple[Array, float]:
    """Forces of a step and their imbalance, all NaN where none are found: the run goes on."""
    solution = result.solution
    try:
        return solution.forces, solution.imbalance
    except (StepNotSolved, ArithmeticError):
        return np.full((result.step.contacts.n_c, 4), np.nan), np.nan


def motions(results: Sequence[StepResult], n_v: int) -> Array:
    """J delta_q of the contacts of some steps, shape (steps, n_c, 4) [m, m, m, rad].

    Of delta_q count the first n_v coordinates, without private rises.
    """
    of_contacts = []
    for result in results:
        delta_q = result.solution.delta_q
        if len(delta_q) > n_v:
            delta_q = np.concatenate([delta_q[:n_v], np.zeros(len(delta_q) - n_v)])
        of_contacts.append(result.step.contacts.motion(delta_q))
    return np.array(of_contacts)


def programs(steps: Sequence[StepData]) -> StepArrays:
    """What a full record adds to steps: the quadratic programs, and what those are made of.

    Returns
    -------
    dict of str to ndarray, shape as in the notation, behind a first axis, the step [-]
        By the notation's names [in its units].
    """
    arrays: StepArrays = {name: _of_all(steps, name) for name in LOADS}
    matrices = [step.recorded for step in steps]
    arrays |= {name: np.array([each[name] for each in matrices]) for name in matrices[0]}
    extra = [step.extra for step in steps]
    if "H" in arrays:
        forms = [standard_form(step) for step in steps]
        arrays |= {name: _of_all(forms, name) for name in ("g", "A", "b")}
    of_extra = ("A", "b") if extra[0].names else ()
    if extra[0].cost is not None:
        of_extra = (*of_extra, "H", "g")
    return arrays | {f"extra_{name}": _of_all(extra, name) for name in of_extra}


def _checked_note(name: str, note: ArrayLike, steps: int, before: Array | None) -> Array:
    """What an observer notes of some steps, shape (steps, ...) [any unit], as it did `before`.

    Raises
    ------
    InputError
    """
    if name in (*IN_ORDER, "q", "tau") or name.startswith(SECONDS):
        raise InputError("is a name of the record's own; take another", field=f"note {name}")
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


def _of_all(objects: Sequence[object], name: str) -> NDArray[Any]:
    """One attribute of all objects as an array, which has them as its first axis."""
    return np.array([getattr(one, name) for one in objects])


def _over_all_steps(parts: list[StepArrays], key: str) -> NDArray[Any]:
    """One array of all steps, in which zero is 0.0, never -0.0."""
    array = np.concatenate([part[key] for part in parts])
    if array.dtype == np.float64:
        array += 0.0
    return array
