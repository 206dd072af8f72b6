"""The steps of a run on disk while it goes on: what is left of one that was killed.

Next to the trajectory's file, ``run.npz``, stands a folder ``run.npz.part``. Each save adds a file
with the steps since the save before, written whole or not at all. What a full record adds is not in
it: it is a function of q, and made again. docs/guides/file_formats.md describes the files.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import itertools
import os
import shutil
import sys
import time
from collections.abc import Iterator, Mapping
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from quasistatic_ref import __version__
from quasistatic_ref.errors import InputError, about_file
from quasistatic_ref.formats.files import is_stream, written_whole
from quasistatic_ref.formats.npz import header_of, json_array, npz_arrays, npz_record
from quasistatic_ref.formats.plain import bits
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.simulate import trajectory as whole_run
from quasistatic_ref.simulate.observer import Observer
from quasistatic_ref.simulate.record import EXTRA, FORCES, PER_STEP, PROGRAM
from quasistatic_ref.simulate.rollout import FIRST_STEP, SAVED_STEPS
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.solve.backends import QPSOLVERS
from quasistatic_ref.step.data import Array

if TYPE_CHECKING:
    from quasistatic_ref.simulate.recorder import Recorder
    from quasistatic_ref.simulate.result import StepArrays
    from quasistatic_ref.simulate.simulator import Simulator

FORMAT = "quasistatic-ref/saved-steps"
VERSION = 1
WHAT = "a file of saved steps"
HASHED = "sha256 "
"""What the value of a setting begins with that is too long to be shown."""


def run_settings(simulator: Simulator, start: Array, record: str) -> dict[str, str]:
    """What decides the bits of a run, by name, but for its target and its force.

    Parameters
    ----------
    simulator : Simulator
    start : ndarray, shape (n_q,)
        Where the run starts [m, rad, -].
    record : str
    """
    system = simulator.system
    said = simulator.settings()
    settings = {
        "version of quasistatic_ref": __version__,
        "version of NumPy": np.__version__,
        **{name: str(one) for name, one in said.items() if isinstance(one, str | float | bool)},
        "gravity": str(simulator.gravity.tolist()),
        "record": record,
        "version of the backend": _version(simulator.backend.removeprefix(QPSOLVERS)),
        **{f"limits.{name}": str(limit) for name, limit in vars(simulator.limits).items()},
        "extension": "none" if simulator.extension is None else "one",
    }
    for body, text in zip(system.bodies, system.texts, strict=True):
        given = (text, body.base, body.actuated, body.xyz, body.rpy)
        settings[f"bodies.{body.name}"] = HASHED + fingerprint(given)
    settings["the order of the bodies"] = ", ".join(body.name for body in system.bodies)
    for pair in simulator.pairs:
        for field in ("mu_v", "mu_omega", "rows", "k"):
            settings[f"{field} of {pair.name}"] = repr(getattr(pair, field))
        settings[f"shapes of {pair.name}"] = HASHED + fingerprint((pair.alpha, pair.beta))
    settings["the order of the contacts"] = ", ".join(pair.name for pair in simulator.pairs)
    arrays = {"K_q": simulator.K_q, "gravity_factor": simulator.gravity_factor, "start": start}
    return settings | {name: HASHED + fingerprint(array) for name, array in arrays.items()}


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"


class SavedSteps(Observer):
    """The saved steps of one run: begun, added to, read, removed when its trajectory is written.

    The run itself is never ended by a save that fails, such as on a full disk: one sentence on
    standard error says so, and the next save tries again. Files guard against a process that ends,
    not against a machine that does.

    Parameters
    ----------
    path : str or Path
        Of the trajectory; the folder is next to it.
    settings : mapping of str to str
        Of :func:`run_settings`.
    kept : tuple of str
        Names of what the run's other observers keep of each step.
    every : float
        Time between two saves [s], at least 0.

    Raises
    ------
    InputError
        If the time is no number of seconds.
    """

    def __init__(
        self,
        path: str | Path,
        settings: Mapping[str, str],
        kept: tuple[str, ...],
        every: float,
    ) -> None:
        if not every >= 0:
            raise InputError("must be at least 0", field="save_every", value=every)
        self.path = Path(path)
        self.settings = dict(settings)
        self.every = every
        self.kept = kept
        self.folder = saved_folder(path)
        self.lock = Lock(self.folder)
        self._saved = 0  # parts of the recorder that are on disk
        self._begun = self._latest = time.monotonic()
        self._failing = False
        self._there = steps_in(path)
        self.written = self.path

    def parts(self) -> Iterator[tuple[StepArrays, tuple[str, ...]]]:
        """The saved steps in order, each part with the names of an extension's rows.

        Raises
        ------
        InputError
            If they are of another run, naming what differs. From the first file on that is spoilt,
            or does not follow, files are kept aside, and one sentence on standard error says so.
        """
        forces = FORCES if self.settings["record"] == "forces" else ()
        good, problem = _longest_prefix(self.folder, {*PER_STEP, *forces, "q", "tau", *self.kept})
        for path in good:
            header, part = npz_record(path, WHAT)
            with about_file(path):
                self._check_settings(header["settings"])
                extra = tuple(TableReader(header).words("extra"))
            yield part, extra
            self._saved += 1
        if problem is not None:
            self._set_aside([path for path in _files(self.folder) if path not in good], problem)

    def _set_aside(self, files: list[Path], problem: InputError) -> None:
        """Keep files that do not follow from those before them, and say so."""
        aside = _free_name(Path(f"{self.path}.left_out"))
        aside.mkdir()
        for path in files:
            path.rename(aside / path.name)
        words = f"{problem}; it and later files, {len(files)} in all, are kept in {aside}"
        print(f"quasistatic-ref: {words}; their steps are taken again", file=sys.stderr)

    def _check_settings(self, then: object) -> None:
        if not isinstance(then, dict):
            raise InputError("must be a table", field="settings")
        for name in {**then, **self.settings}:
            was = then.get(name)
            now = self.settings.get(name)
            if was != now:
                shown = f": {was or 'nothing'} then, {now or 'nothing'} now"
                values = "" if HASHED in f"{was}{now}" else shown
                problem = (
                    f"was saved by a run that differs in {name}{values}; run what it is of, or "
                    "remove that folder to begin from the start"
                )
                raise InputError(problem, file=self.folder)

    def before(self, recorder: Recorder) -> None:
        """Save what a recorder has, if it is time."""
        if time.monotonic() - self._latest >= self.every:
            self.save(recorder)

    def save(self, recorder: Recorder) -> None:
        """Write the steps since the save before into a file of their own."""
        parts = recorder.packed()
        # A part is incomplete if an observer was interrupted.
        new = list(
            itertools.takewhile(lambda part: part.keys() >= {*self.kept}, parts[self._saved :])
        )
        if new:
            keys = [key for key in new[0] if key not in (*PROGRAM, *EXTRA[1:])]
            arrays: dict[str, Any] = {key: np.concatenate([p[key] for p in new]) for key in keys}
            steps = len(arrays["t"])
            first = sum(len(part["t"]) for part in parts[: self._saved])
            header = {
                "format": FORMAT,
                "version": VERSION,
                "first": first,
                "steps": steps,
                "extra": list(recorder.extra),
                "settings": self.settings,
            }
            arrays["header"] = json_array(header)
            path = self.folder / f"{first:09d}.npz"
            try:
                written_whole(path, lambda file: np.savez(file, **arrays))
                self._saved += len(new)
                self._failing = False
            except InputError as error:
                if not self._failing:
                    print(f"quasistatic-ref: {error}; the run goes on", file=sys.stderr)
                self._failing = True
        self._latest = time.monotonic()

    def end(self, recorder: Recorder, trajectory: Trajectory, interrupted: bool) -> Trajectory:
        """Write the trajectory; of an interrupted run that is worth it, keep the saved steps.

        It is written next to its place, and `written` says where, if the run ended before it had as
        many steps as the one there.
        """
        if trajectory.steps < self._there:
            self.written = self.path.with_name(f"{self.path.stem}_failed{self.path.suffix}")
        if interrupted and (time.monotonic() - self._begun >= self.every or self._saved):
            self.save(recorder)
        trajectory.save(self.written)
        if not interrupted:
            self.remove()
        return trajectory

    def remove(self) -> None:
        """Remove the saved steps, the last ones first: what is left is whole at any time."""
        for path in reversed(_files(self.folder)):
            path.unlink(missing_ok=True)
        shutil.rmtree(self.folder, ignore_errors=True)


class Lock:
    """A folder of saved steps that this object alone writes into, made if it is not there.

    The system holds it, and lets go when the process ends, however it ends: none is left behind.

    Parameters
    ----------
    folder : Path

    Raises
    ------
    InputError
        If another run writes into it, or it cannot be made.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._descriptor: int | None = None
        while self._descriptor is None:
            try:
                folder.mkdir(parents=True, exist_ok=True)
                descriptor = os.open(folder, os.O_RDONLY)
            except OSError as error:
                reason = error.strerror or str(error)
                problem = f"cannot be written: {reason}; choose another folder"
                raise InputError(problem, file=folder.parent) from None
            try:
                fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                if os.path.samestat(os.fstat(descriptor), os.stat(folder)):
                    self._descriptor = descriptor
            except BlockingIOError:
                problem = "is being written by another run; wait for its end"
                raise InputError(problem, file=folder) from None
            except FileNotFoundError:
                pass  # the run before has just removed it
            finally:
                if self._descriptor is None:
                    os.close(descriptor)

    def release(self) -> None:
        """Let others write; an empty folder is removed."""
        if self._descriptor is not None:
            with contextlib.suppress(OSError):  # it holds saved steps, or is gone
                self.folder.rmdir()
            os.close(self._descriptor)
            self._descriptor = None

    def __enter__(self) -> Lock:
        return self

    def __exit__(self, *exception: object) -> None:
        self.release()


def first_step(path: str | Path, steps: int, resume: bool) -> int:
    """The step that a run begins with: 0, or that after the saved ones.

    Parameters
    ----------
    path : str or Path
        Of its trajectory.
    steps : int
        Of the whole run.
    resume : bool
        Whether it goes on from the saved steps.

    Raises
    ------
    InputError
        If the run would lose steps that are there: a longer trajectory, or saved steps that it does
        not go on from; or if the file holds something else.
    """
    folder = saved_folder(path)
    if os.path.isdir(folder):  # false of a name that is too long, which Path.is_dir refuses
        Lock(folder).release()
    there = steps_in(path)
    saved = saved_steps(path)
    if there > steps:
        problem = (
            f"holds a run of {there} steps, which one of {steps} steps does not replace; choose "
            "another folder, or remove it"
        )
        raise InputError(problem, file=path)
    if _files(folder) and not resume:
        problem = (
            f"holds the first {saved} steps of a run that did not end; go on from there with "
            "--resume (in Python: resume=True), or remove that folder"
        )
        raise InputError(problem, file=folder)
    if saved > steps:
        problem = (
            f"holds the first {saved} steps of a run, and this one has {steps}; go on with at "
            "least as many, or remove that folder"
        )
        raise InputError(problem, file=folder)
    return saved


def _npz_header(path: str | Path, what: str) -> Any:
    """The header alone, as :func:`npz_record` reads it."""
    return header_of(path, what, npz_arrays(path, what, only="header").get("header"))


def saved_folder(path: str | Path) -> Path:
    """The folder of the saved steps of a run whose trajectory's file is `path`."""
    return Path(f"{path}.part")


def saved_steps(path: str | Path) -> int:
    """How many steps are saved of a run whose trajectory's file is `path`, without a gap."""
    good, _ = _longest_prefix(saved_folder(path), set())
    return sum(_npz_header(file, WHAT)["steps"] for file in good)


def _longest_prefix(folder: Path, needed: set[str]) -> tuple[list[Path], InputError | None]:
    """The files that follow each other from step 0 on, and what is wrong with the next one.

    Parameters
    ----------
    folder : Path
    needed : set of str
        Names of arrays that each file has.
    """
    good: list[Path] = []
    expected = 0
    for path in _files(folder):
        try:
            header, part = npz_record(path, WHAT)
            with about_file(path):
                expected += _steps_after(TableReader(header), part, expected, needed)
        except InputError as error:
            return good, error
        good.append(path)
    return good, None


def _steps_after(top: TableReader, part: StepArrays, expected: int, needed: set[str]) -> int:
    """How many steps a file holds, of which the first is the expected one."""
    top.text("format", choices=(FORMAT,))
    fits = top.integer("version") == VERSION and top.integer("first") == expected
    steps = top.integer("steps", least=1)
    top.words("extra")
    top.table("settings")
    missing = not needed <= set(part)
    if not fits or missing or any(a.ndim == 0 or len(a) != steps for a in part.values()):
        raise InputError(f"is not what follows step {expected}")
    return steps


def _free_name(path: Path) -> Path:
    """The path, or that with the first number behind it that is free."""
    numbered = (path.with_name(f"{path.name}.{i}") for i in itertools.count(2))
    return next(p for p in (path, *itertools.islice(numbered, 1000)) if not p.exists())


def _files(folder: Path) -> list[Path]:
    return sorted(folder.glob("[0-9]*.npz")) if os.path.isdir(folder) else []


def steps_in(path: str | Path) -> int:
    """How many steps the trajectory in a file has; 0 if there is no such file, or an empty one.

    Raises
    ------
    InputError
        If the file holds something else.
    """
    path = Path(path)
    if not os.path.isfile(path) or is_stream(path) or not path.stat().st_size:
        return 0
    try:
        top = TableReader(_npz_header(path, whole_run.WHAT))
        top.check_format(whole_run.FORMAT, whole_run.VERSION)
        return top.integer("steps", least=0)
    except InputError as error:
        remedy = "it is not replaced by one; choose another folder, or remove it"
        raise InputError(f"{error.problem}; {remedy}", file=path) from None


def fingerprint(value: object) -> str:
    """SHA-256 of what :func:`~quasistatic_ref.formats.plain.bits` compares, in hexadecimal.

    It is the same in every process: of arrays, texts and shapes, and not of mappings, whose order
    is not.
    """
    return hashlib.sha256(repr(bits(value)).encode()).hexdigest()


FIRST_STEP.fill(first_step)
SAVED_STEPS.fill(saved_steps)
