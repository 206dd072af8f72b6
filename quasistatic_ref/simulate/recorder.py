"""Steps as they are taken, collected into a trajectory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError
from quasistatic_ref.simulate.artifacts import (
    boundary_layer,
    drag_share,
    gap_after,
    quasi_dynamic_number,
    warning,
)
from quasistatic_ref.simulate.record import CONSTANT, RECORDS
from quasistatic_ref.simulate.trajectory import FORMAT, VERSION, Trajectory
from quasistatic_ref.simulate.watch import doubtful_units, watched
from quasistatic_ref.simulate.wrenches import Scene
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import standard_form

if TYPE_CHECKING:
    from quasistatic_ref.simulate.simulator import Simulator, StepResult


class Recorder:
    """Collects the results of steps into a trajectory.

    Parameters
    ----------
    simulator : Simulator
        What takes the steps.
    q : ndarray, shape (n_q,)
        Where the run starts; quaternions are normalised.
    record : str
        ``"full"``, or ``"light"`` to leave out the quadratic programs.

    Raises
    ------
    InputError
        If there is no such record, or q is no configuration.
    """

    def __init__(self, simulator: Simulator, q: Array, record: str = "full") -> None:
        if record not in RECORDS:
            raise InputError(f"must be one of {', '.join(RECORDS)}", field="record", value=record)
        self.scene = Scene(simulator.system, simulator.pairs)
        self.system, self.h, self.backend = simulator.system, simulator.h, simulator.backend
        self.cone, self.record = simulator.cone, record
        self.q, self.g = [self.system.checked(q)], float(np.linalg.norm(simulator.gravity))
        self.extra: tuple[str, ...] = ()
        self.Pi: float | None = None
        self.drag: float | None = None
        self.layer = 0.0
        self.gap: list[Array] = []
        self.rows: list[dict[str, Any]] = []
        self.names: list[tuple[str, ...]] = []
        self.seconds: list[dict[str, float]] = []
        self.constant: dict[str, NDArray[Any]] = {}

    @property
    def t(self) -> float:
        """End of the step that comes next [s]."""
        return (len(self.rows) + 1) * self.h

    def add(self, q_bar_a: Array, result: StepResult) -> None:
        """Record one step that succeeded.

        Parameters
        ----------
        q_bar_a : ndarray, shape (n_q_a,)
            Its target.
        result : StepResult
        """
        step, solution, points = result.step, result.solution, result.points
        self.Pi = _larger(
            self.Pi, quasi_dynamic_number(self.system, step, solution.delta_q, self.g)
        )
        self.drag = _larger(self.drag, drag_share(self.system, step, solution, self.g))
        self.gap.append(gap_after(step, solution))
        self.layer = max(self.layer, boundary_layer(self.gap[-1], solution))
        row: dict[str, Any] = {
            "t": self.t,
            "delta_q": solution.delta_q,
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
        }
        if self.record == "full":
            form = standard_form(step)
            row |= {"H": form.H, "g": form.g, "A": form.A, "b": form.b, "J": step.contacts.J}
            for key in ("K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a"):
                row[key] = getattr(step, key)
        if step.extra.names:
            row["lam_extra"] = solution.lam_extra
            if self.record == "full":
                row |= {"extra_A": step.extra.A, "extra_b": step.extra.b}
        self.extra = step.extra.names
        self.rows.append(row)
        self.q.append(result.q)
        self.names.append(step.contacts.name)
        self.seconds.append(result.seconds)
        self.constant = {key: getattr(step.contacts, key) for key in CONSTANT}

    def trajectory(self, failed: str | None = None) -> Trajectory:
        """Everything recorded so far."""
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
            "steps": len(self.rows),
            "failed": failed,
            "quasi_dynamic_number": self.Pi,
            "largest_drag_share": self.drag,
            "largest_boundary_layer": self.layer,
            "contacts": self.names if self.record == "full" else [],
        }
        keys = self.rows[0] if self.rows else ("t", "delta_q", "worst_residual")
        arrays = {key: _stacked([row[key] for row in self.rows]) for key in keys}
        constant = self.constant or {key: np.zeros(0) for key in CONSTANT}
        parts = self.seconds[0] if self.seconds else {}
        seconds = {part: np.array([s[part] for s in self.seconds]) for part in parts}
        arrays = {"q": np.array(self.q), **arrays, **constant}
        drags = warning(header)
        header["warnings"] = [] if drags is None else [drags]
        if self.rows:
            header["warnings"] += watched(self.scene, arrays, np.array(self.gap))
        else:  # it failed in its first step, for which a unit may be the reason
            header["warnings"] += doubtful_units(self.scene)
        return Trajectory(header, arrays, seconds, self.scene)


def _stacked(values: list[Any]) -> NDArray[Any]:
    """One array of all steps, in which zero is 0.0, never -0.0."""
    array = np.array(values)
    return array + 0.0 if array.dtype == np.float64 else array


def _larger(x: float | None, y: float | None) -> float | None:
    return max((value for value in (x, y) if value is not None), default=None)


def _or_nan(value: float | None) -> float:
    return np.nan if value is None else value
