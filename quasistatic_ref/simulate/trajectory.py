"""What happened: arrays over the steps, with a header, in one ``.npz`` file without pickles."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError
from quasistatic_ref.fields import Fields
from quasistatic_ref.files import json_text, text_of, unique_fields, written_whole
from quasistatic_ref.model.system import System
from quasistatic_ref.simulate.artifacts import boundary_layer, quasi_dynamic_number
from quasistatic_ref.simulate.npz import npz_arrays
from quasistatic_ref.step.data import Array, Contacts, StepData
from quasistatic_ref.step.standard_form import standard_form

if TYPE_CHECKING:
    from quasistatic_ref.simulate.simulator import StepResult

FORMAT = "quasistatic-ref/trajectory"
VERSION = 1
RECORDS = ("full", "light")
CONSTANT = ("mu_v", "mu_omega", "rows")
"""Arrays without a step axis."""
PER_STEP = (
    "t", "delta_q", "q_bar_a", "phi", "alpha", "beta", "n", "d1", "d2", "point", "lam", "wrench",
    "certificate", "worst_residual", "digits",
)  # fmt: skip
PROGRAM = ("H", "g", "A", "b", "J", "K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a")
"""What a full record adds, step by step."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """A run, or the part of it that succeeded.

    Parameters
    ----------
    header : mapping
        format, version, h, backend, record, n_a, n_u, coordinates, contacts (names by step),
        steps; ``quasi_dynamic_number`` (the largest Pi of a step, or None) and
        ``largest_boundary_layer`` [m], see :mod:`~quasistatic_ref.simulate.artifacts`; and
        ``failed``: the reason, or None for a complete run.
    arrays : mapping of str to ndarray
        The first axis is the step: ``t`` (end of the step), ``delta_q``, ``q_bar_a``, ``phi``,
        ``alpha``, ``beta``, ``n``, ``d1``, ``d2``, ``point``, ``lam``, ``wrench``,
        ``certificate`` (its kind), ``worst_residual`` (natural units; NaN where nothing was
        certified), ``digits`` (correct ones of the backend; NaN where the exact answer is not
        known); ``q`` has one entry more, the start. A full record adds ``H``, ``g``, ``A``, ``b``
        and what they are made of: ``K_q``, ``M_u``, ``tau_a``, ``tau_u``, ``delta_q_bar_a``,
        ``J``. ``mu_v``, ``mu_omega`` and ``rows`` are constant.
    seconds : mapping of str to ndarray
        Wall time of the parts of each step; kept in memory only, so that equal runs make equal
        files.
    """

    header: Mapping[str, Any]
    arrays: Mapping[str, NDArray[Any]]
    seconds: Mapping[str, Array] = field(default_factory=dict)

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.arrays[name]

    @property
    def steps(self) -> int:
        """Number of steps that succeeded."""
        return len(self.arrays["t"])

    @property
    def failed(self) -> str | None:
        """Why the run ended early, or None."""
        reason = self.header["failed"]
        return None if reason is None else str(reason)

    def step_data(self, k: int) -> StepData:
        """The problem of step k (from 0), bit for bit as it was solved.

        Raises
        ------
        InputError
            If there is no such step, or the record is light.
        """
        if not 0 <= k < self.steps:
            raise InputError(f"must be 0 to {self.steps - 1}", field="step", value=k)
        if self.header["record"] != "full":
            raise InputError("a light record holds no problems; run again with record = 'full'")
        a = self.arrays
        keys = ("phi", "n", "d1", "d2", "J")
        contacts = Contacts(
            name=tuple(self.header["contacts"][k]),
            **{key: a[key][k] for key in keys},
            **{key: a[key] for key in CONSTANT},
        )
        parts = ("K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a")
        return StepData(h=self.header["h"], **{key: a[key][k] for key in parts}, contacts=contacts)

    def save(self, path: str | Path) -> Path:
        """Write the file, whole or not at all."""
        header = np.frombuffer(json_text(dict(self.header)).encode(), dtype=np.uint8)
        arrays: dict[str, Any] = {"header": header, **self.arrays}
        return written_whole(path, lambda file: np.savez_compressed(file, **arrays))


def trajectory_read(path: str | Path) -> Trajectory:
    """Read a trajectory file.

    Raises
    ------
    InputError
        If it is not one, is of another version, or its header and arrays do not fit together.
    """
    arrays = npz_arrays(path)
    try:
        header = _header(arrays.pop("header", None), path)
        top = Fields(header)
        top.text("format", choices=(FORMAT,))
        version = top.integer("version")
        if version != VERSION:
            raise top.fail("version", f"is not known here; this program reads {VERSION}", version)
        _check_arrays(top, arrays)
    except InputError as error:
        raise error.in_file(path) from None
    return Trajectory(header, arrays)


def _header(array: NDArray[Any] | None, path: str | Path) -> Any:
    problem = "is not a trajectory written by this program"
    if array is None or array.dtype != np.uint8:
        raise InputError(f"{problem}: it has no header")
    try:
        return json.loads(text_of(array.tobytes(), path), object_pairs_hook=unique_fields)
    except (ValueError, RecursionError):
        raise InputError(f"{problem}: its header is not JSON") from None


def _check_arrays(top: Fields, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Refuse a header and arrays that do not belong together."""
    _check_present(arrays, ("t", "q", "delta_q", *CONSTANT))
    steps = top.integer("steps", least=0)
    full = top.text("record", choices=RECORDS) == "full"
    top.number("h", above=0.0)
    if not top.is_null("failed"):
        top.text("failed")
    needed: tuple[str, ...] = ("t", "delta_q")
    if steps:
        needed = (*PER_STEP, *PROGRAM) if full else PER_STEP
        _check_present(arrays, needed)
    for name, array in arrays.items():
        if array.dtype.kind not in ("U" if name == "certificate" else "fiu"):
            raise InputError("must hold numbers", field=name, value=str(array.dtype))
    for name, length in {**dict.fromkeys(needed, steps), "q": steps + 1}.items():
        if arrays[name].ndim == 0 or len(arrays[name]) != length:
            problem = f"must have {length} entries, as the header says"
            raise InputError(problem, field=name, value=arrays[name].shape)
    contacts = top.sequence("contacts")
    if full and len(contacts) != steps:
        raise top.fail("contacts", f"must have {steps} entries", len(contacts))
    if not all(isinstance(names, list) for names in contacts):
        raise top.fail("contacts", "must be lists of names", contacts)


def _check_present(arrays: Mapping[str, NDArray[Any]], names: Iterable[str]) -> None:
    missing = sorted(set(names) - set(arrays))
    if missing:
        raise InputError(f"holds no array named {missing[0]!r}")


def certified(trajectory: Trajectory) -> str:
    """How many steps are certified exactly, e.g. ``"300 of 300 steps exact"``."""
    exact = int(np.sum(trajectory["certificate"] == "exact")) if trajectory.steps else 0
    return f"{exact} of {trajectory.steps} steps exact"


def _or_nan(value: float | None) -> float:
    return np.nan if value is None else value


def worst_residual(trajectory: Trajectory) -> float | None:
    """Largest residual of all steps, in natural units [-]; None where none was computed."""
    residuals = trajectory["worst_residual"]
    if not residuals.size or np.isnan(residuals).any():
        return None
    return float(residuals.max())


class Recorder:
    """Collects the results of steps into a trajectory.

    Parameters
    ----------
    system : System
    h : float
    backend : str
    record : str
        ``"full"`` or ``"light"``.
    q : ndarray, shape (n_q,)
        Where the run starts.
    g : float
        Length of gravity [m/s^2].
    """

    def __init__(
        self, system: System, h: float, backend: str, record: str, q: Array, g: float = 0.0
    ) -> None:
        if record not in RECORDS:
            raise InputError(f"must be one of {', '.join(RECORDS)}", field="record", value=record)
        self.system, self.h, self.backend, self.record = system, h, backend, record
        self.q, self.g = [q], g
        self.Pi: float | None = None
        self.layer = 0.0
        self.rows: list[dict[str, Any]] = []
        self.names: list[tuple[str, ...]] = []
        self.seconds: list[dict[str, float]] = []
        self.constant: dict[str, NDArray[Any]] = {}

    def add(self, t: float, q_bar_a: Array, result: StepResult) -> None:
        """Record one step that succeeded."""
        step, solution, points = result.step, result.solution, result.points
        Pi = quasi_dynamic_number(self.system, step, solution.delta_q, self.g)
        self.Pi = Pi if self.Pi is None or Pi is None else max(Pi, self.Pi)
        self.layer = max(self.layer, boundary_layer(step, solution))
        row: dict[str, Any] = {
            "t": t,
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
        self.rows.append(row)
        self.q.append(result.q)
        self.names.append(step.contacts.name)
        self.seconds.append(result.seconds)
        self.constant = {key: getattr(step.contacts, key) for key in CONSTANT}

    def trajectory(self, failed: str | None = None) -> Trajectory:
        """Everything recorded so far."""
        header = {
            "format": FORMAT,
            "version": VERSION,
            "h": self.h,
            "backend": self.backend,
            "record": self.record,
            "n_a": self.system.n_a,
            "n_u": self.system.n_u,
            "coordinates": [c.name for c in self.system.coordinates],
            "steps": len(self.rows),
            "failed": failed,
            "quasi_dynamic_number": self.Pi,
            "largest_boundary_layer": self.layer,
            "contacts": self.names if self.record == "full" else [],
        }
        keys = self.rows[0] if self.rows else ("t", "delta_q", "worst_residual")
        arrays = {key: np.array([row[key] for row in self.rows]) for key in keys}
        constant = self.constant or {key: np.zeros(0) for key in CONSTANT}
        parts = self.seconds[0] if self.seconds else {}
        seconds = {part: np.array([s[part] for s in self.seconds]) for part in parts}
        return Trajectory(header, {"q": np.array(self.q), **arrays, **constant}, seconds)
