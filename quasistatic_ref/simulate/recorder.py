"""Steps as they are taken, collected into a trajectory."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.parts import needed_part
from quasistatic_ref.simulate.law import CONVEX, COULOMB, ITERATED
from quasistatic_ref.simulate.observer import Observer, doctors
from quasistatic_ref.simulate.record import CONSTANT, EXTRA, FORCES, PER_STEP, PROGRAM, RECORDS
from quasistatic_ref.simulate.target import JointTrack
from quasistatic_ref.simulate.trajectory import FORMAT, VERSION, Trajectory
from quasistatic_ref.step.arrays import read_only
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.step.standard_form import standard_form

if TYPE_CHECKING:
    from quasistatic_ref.simulate.result import StepResult
    from quasistatic_ref.simulate.simulator import Simulator

PACKED = 1000
"""Steps that are kept one by one before they become arrays, which take less memory."""
SECONDS = "seconds."
"""What the names of wall times begin with."""

StepArrays = dict[str, NDArray[Any]]
"""Arrays over some steps that follow one another."""


class Recorder(Shown):
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

    Attributes
    ----------
    simulator : Simulator
    observers : list of Observer
    steps : int
        Number of steps so far.
    start, q : ndarray, shape (n_q,)
        Where the run started, and where it is.
    parts : list of dict
        The steps so far but for the latest ones, see :meth:`packed`.

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
        q: Array,
        record: str = "full",
        observers: Sequence[Observer] | None = None,
    ) -> None:
        if record not in RECORDS:
            raise InputError(f"must be one of {', '.join(RECORDS)}", field="record", value=record)
        if record == "forces":
            needed_part("forces.forces", 'record = "forces"')
        self.simulator = simulator
        self.scene = simulator.scene
        self.system = simulator.system
        self.h = simulator.h
        self.backend = simulator.backend
        self.cone = simulator.cone
        self.layout = simulator.layout
        self.record = record
        self.observers = list(doctors() if observers is None else observers)
        self.start = self.system.checked(q)
        self.q = self.start
        self.steps = 0
        self.tracks: Sequence[JointTrack] = ()
        self.extra: tuple[str, ...] = ()
        self.alone = True
        self.parts: list[StepArrays] = []
        self._rows: list[dict[str, Any]] = []

    @property
    def t(self) -> float:
        """End of the step that comes next [s]."""
        return (self.steps + 1) * self.h

    def add(self, q_bar_a: Array, result: StepResult) -> None:
        """Record one step that succeeded.

        Parameters
        ----------
        q_bar_a : ndarray, shape (n_q_a,)
            Its target.
        result : StepResult
        """
        step = result.step
        solution = result.solution
        points = result.points
        row: dict[str, Any] = {
            "t": self.t,
            "delta_q": solution.delta_q[: self.system.n_v],  # without private rises
            "q_bar_a": q_bar_a,
            "phi": points.phi,
            "alpha": points.alpha,
            "beta": points.beta,
            "n": points.n,
            "d1": step.contacts.d1,
            "d2": step.contacts.d2,
            "point": points.point,
            "lam": solution.lam,
            "wrench": solution.wrench,
            "certificate": solution.certificate.kind,
            "worst_residual": max(solution.certificate.residuals.values(), default=np.nan),
            "digits": _or_nan(solution.statistics.digits),
            "q": result.q,
            "tau": np.concatenate([step.tau_a, step.tau_u])[: self.system.n_v],
        }
        for observer in self.observers:
            notes = observer.after(self, result)
            row |= {name: _or_nan(value) for name, value in notes.items()}
        row |= {SECONDS + part: seconds for part, seconds in result.seconds.items()}
        if self.record == "full":
            row |= program(step)
        first: Any = self.parts or self._rows
        known = self.record == "forces"
        if self.record == "full":
            known = "forces" in first[0] if first else self.simulator.records_forces(solution)
        if known:
            row["forces"] = solution.forces
        if self.record == "forces":
            row["imbalance"] = solution.imbalance
            delta_q = solution.delta_q.copy()
            delta_q[self.system.n_v :] = 0.0
            row["motion"] = step.contacts.motion(delta_q)
        if self.simulator.law == COULOMB:
            row |= {name: getattr(solution, name) for name in ITERATED}
        self.alone &= solution.alone
        if step.extra.names:
            row["lam_extra"] = solution.lam_extra
        self.extra = step.extra.names
        self._rows.append(row)
        self.q = read_only(result.q)  # a function of (t, q) cannot change where it starts
        self.steps += 1
        if len(self._rows) == PACKED:
            self.packed()

    def packed(self) -> list[StepArrays]:
        """All steps so far as arrays, in parts: those added since the call before are the last."""
        if self._rows:
            self.parts.append(
                {key: np.array([r[key] for r in self._rows]) for key in self._rows[0]}
            )
            self._rows = []
        return self.parts

    def take(self, part: StepArrays, extra: tuple[str, ...]) -> None:
        """Add steps that were taken before, as :meth:`packed` gave them.

        Parameters
        ----------
        part : dict of str to ndarray
            Of the notation's shape and unit, behind a first axis, the step [-].
        extra : tuple of str
            Names of an extension's rows.
        """
        self.parts.append(part)
        self.extra = extra
        self.q = part["q"][-1]
        self.steps += len(part["q"])

    @property
    def notes(self) -> tuple[str, ...]:
        """Names of what the observers keep of each step."""
        return tuple(name for observer in self.observers for name in observer.notes)

    def noted(self, name: str) -> NDArray[Any]:
        """What an observer kept of each step so far, shape (steps, ...) [any unit]."""
        parts = self.packed()
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
        parts = self.packed()
        kept = parts[0] if parts else {}
        known = [name for name in (*PER_STEP, *PROGRAM, *FORCES, *EXTRA, *ITERATED) if name in kept]
        arrays = {name: _over_all_steps(parts, name) for name in known} or {
            name: np.zeros(0) for name in ("t", "delta_q", "worst_residual")
        }
        full = self.steps and self.record == "full"
        names = self.layout.contact_names
        header: dict[str, Any] = {
            "format": FORMAT,
            "version": VERSION,
            "h": self.h,
            "backend": self.backend,
            "cone": self.cone,
            "extra": list(self.extra),
            "record": self.record,
            "n_a": self.system.n_a,
            "n_u": self.system.n_u,
            "coordinates": [c.name for c in self.system.coordinates],
            "units": [c.unit for c in self.system.coordinates],
            "positions": [name for joint in self.system.joints for name in joint.positions],
            "slots": list(self.layout.slots),
            "steps": self.steps,
            "failed": failed,
            "quasi_dynamic_number": None,  # the observers know
            "largest_drag_share": None,
            "largest_boundary_layer": None,
            "contacts": [list(names(p)) for p in arrays["point"]] if full else [],
            "findings": [],
        } | ({} if self.alone else {"alone": False})
        if self.simulator.law != CONVEX:
            header["law"] = self.simulator.law
        constant = {k: getattr(self.layout, k) if self.steps else np.zeros(0) for k in CONSTANT}
        q = np.concatenate([self.start[None], *(part["q"] for part in parts)])
        arrays = {"q": q + 0.0, **arrays, **constant}
        timed = [name for name in kept if name.startswith(SECONDS)]
        seconds = {name.removeprefix(SECONDS): _over_all_steps(parts, name) for name in timed}
        trajectory = Trajectory(header, arrays, seconds, self.scene)
        for observer in self.observers:
            trajectory = observer.end(self, trajectory, interrupted)
        return trajectory


def program(step: StepData) -> dict[str, Array]:
    """What a full record adds to a step: the quadratic program, and what that is made of.

    Returns
    -------
    dict of str to ndarray, shape as in the notation
        By the notation's names [in its units].
    """
    form = standard_form(step)
    row = {"H": form.H, "g": form.g, "A": form.A, "b": form.b, "J": step.contacts.J}
    row |= {key: getattr(step, key) for key in PROGRAM if key not in row}
    if step.extra.names:
        row |= {"extra_A": step.extra.A, "extra_b": step.extra.b}
    return row


def _over_all_steps(parts: list[StepArrays], key: str) -> NDArray[Any]:
    """One array of all steps, in which zero is 0.0, never -0.0."""
    array = np.concatenate([part[key] for part in parts])
    return array + 0.0 if array.dtype == np.float64 else array


def _or_nan(value: Array | float | None) -> Array | float:
    return np.nan if value is None else value
