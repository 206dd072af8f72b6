"""Many runs of one scenario at once: a grid of values, a trajectory a run, and one table."""

import csv
import io
import math
import re
import time
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.files.option_change import OptionChange
from quasistatic_ref.files.resources import scenario_path
from quasistatic_ref.files.scenario.overrides import parsed
from quasistatic_ref.files.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.files.trajectory import load_trajectory, save_trajectory
from quasistatic_ref.lab.lock import locked
from quasistatic_ref.lab.parallel import results
from quasistatic_ref.lab.parallel import workers as workers_here
from quasistatic_ref.optional.doctor.did.numbers import by_name, numbers_of
from quasistatic_ref.quoting import no_formula
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.simulate.record.failures import RunFailed
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.text.content import text_written, writable_folder
from quasistatic_ref.text.json_text import json_text
from quasistatic_ref.tolerances import LARGE

TABLE = "runs.csv"
RUNS = "runs"
"""Folder of trajectories next to the table."""
DONE = "done"
ENDED_EARLY = "ended_early"
LAYER = "boundary_layer_um"
MOST_RUNS = 100_000
WHOLE = re.compile(r"\s*[+-]?\d+\s*")
"""A whole number, as an end of a range is written."""
ROOM = 50_000_000
"""What may be kept of scenarios that have been checked [bytes]; half a million a scene."""
SCENE = 500_000
Row = dict[str, Any]
_loaded: dict[tuple[str, tuple[str, ...]], tuple[int, Scenario]] = {}
"""Scenarios that this process has checked and not run yet, each with its size [bytes]."""


def simulate_many(
    scenario: str | Path,
    variations: Mapping[str, Iterable[float | str]],
    folder: str | Path,
    *,
    settings: Sequence[str] = (),
    workers: int | None = None,
    executor: Executor | None = None,
    progress: bool = True,
) -> list[Row]:
    """Run a scenario with every combination of some values, several runs at a time.

    A run that ends early is a result, too.

    Parameters
    ----------
    scenario : str or Path
        A name, or a file.
    variations : mapping of str to iterable of float or str
        Dotted field of the scenario -> its values [the field's unit]; of several fields with the
        same values, their names with commas between.
    folder : str or Path
        For ``runs.csv``, one line a run, written as runs end, and ``runs/*.npz``, one light
        trajectory a run, numbered in the order of the values. Runs of this sweep that are there
        already are kept: one that was ended goes on.
    settings : sequence of str
        Changes of the scenario that all runs have, as :func:`.load_scenario` takes them.
    workers : int, optional
        Processes on this machine; by default as many as there are cores.
    executor : Executor, optional
        Any of ``concurrent.futures``, in place of this machine's processes; what it calls must find
        the scenario, and need not see the folder.
    progress : bool

    Returns
    -------
    list of dict
        One row a run, in the order of the values: ``run``, its file; ``values``; ``outcome``;
        ``reason``, why it ended early; ``findings``, their names, and ``not_looked_at``, what they
        leave out; ``measures``.

    Raises
    ------
    InputError
        If a field, a value or any of the scenarios is unusable, or the folder holds runs of
        another sweep, or is written into by one: before anything is written.
    """
    grid = {name: _value_list(name, values) for name, values in variations.items()}
    count = math.prod(map(len, grid.values()))
    if not grid or count > MOST_RUNS:
        problem = f"must make 1 to {MOST_RUNS} runs"
        raise InputError(problem, field="variations", value=count if grid else 0)
    if workers is not None and workers < 1:
        raise InputError("must be at least 1", field="workers", value=workers)
    path = scenario_path(scenario)
    source = str(path.resolve()) if path == Path(scenario) else str(scenario)
    points = [dict(zip(grid, values, strict=True)) for values in product(*grid.values())]
    changes = [_changes(point, settings) for point in points]
    here: AbstractContextManager[Executor | None] = (
        nullcontext(executor) if executor else workers_here(workers)
    )
    with here as pool:
        # An error of any of the scenarios is raised here.
        list((pool.map if pool else map)(check_scenario, [source] * count, changes))
        folder = writable_folder(folder)
        files = [f"{RUNS}/{path.stem}_{k:0{len(str(count - 1))}}.npz" for k in range(count)]
        tasks = [(file, source, one) for file, one in zip(files, changes, strict=True)]
        with locked(folder), progress_bar(total=count, unit="run", shown=progress) as bar:
            table = _Table(folder, dict(zip(files, points, strict=True)))
            table.done |= _kept(folder, tasks)
            bar.update(len(table.done))
            left = [task for task in tasks if task[0] not in table.done]
            try:
                for file, trajectory, row in results(pool, run_of, left):
                    save_trajectory(folder / file, trajectory)
                    table.add(file, row)
                    bar.update()
            finally:  # what is done so far, if it is interrupted
                _loaded.clear()
                table.write()
    return table.rows


class _Table:
    """The table of the runs that have ended, in the order of the values.

    A run that ends adds a line. Where it has a new column, the file is written anew, unless that
    would take more than a tenth of the time; so it is in the end, in the order of the values.

    Parameters
    ----------
    folder : Path
    points : dict of str to dict
        The values of each run, by its file.
    """

    def __init__(self, folder: Path, points: Mapping[str, Mapping[str, Any]]) -> None:
        self._path = folder / TABLE
        self._points = points
        self._not_before = 0.0
        self._columns: list[str] = []
        self.done: dict[str, Row] = {}

    @property
    def rows(self) -> list[Row]:
        """A row for each run that has ended."""
        return [
            {"run": file, "values": point, **self.done[file]}
            for file, point in self._points.items()
            if file in self.done
        ]

    def add(self, file: str, row: Row) -> None:
        """Take the row of a run that has ended."""
        self.done[file] = row
        if set(row["measures"]) <= set(self._columns):
            with self._path.open("a", encoding="utf-8", newline="") as table:
                cells = {"run": file, "values": self._points[file], **row}
                table.write(_lines([_cells(cells, self._columns)]))
        elif (begin := time.monotonic()) >= self._not_before:
            self.write()
            self._not_before = time.monotonic() + 9 * (time.monotonic() - begin)

    def write(self) -> None:
        """Write the file, if there is a row."""
        if self.done:
            rows = self.rows
            self._columns = list(dict.fromkeys(name for row in rows for name in row["measures"]))
            text_written(self._path, _table(rows, self._columns))


def _kept(folder: Path, tasks: Sequence[tuple[str, str, Sequence[str]]]) -> dict[str, Row]:
    """The rows of the runs of a sweep that the folder has, by their files.

    Raises
    ------
    InputError
        If it has a run, or a table, of another.
    """
    kept: dict[str, Row] = {}
    refusal = InputError("holds runs of another sweep; choose another folder", file=folder)
    there = {f"{RUNS}/{path.name}" for path in (folder / RUNS).glob("*.npz")}
    if there - {file for file, *_ in tasks} or ((folder / TABLE).exists() and not there):
        raise refusal
    for file, scenario, changes in tasks:
        if file in there:
            trajectory = load_trajectory(folder / file)
            loaded = load_scenario(scenario, changes)
            is_another = trajectory.header.scene_sha256 != loaded.fingerprint
            if is_another or not (trajectory.failed or trajectory.steps == loaded.steps):
                raise refusal
            if not trajectory.failed:  # limits may be others: it is run again
                kept[file] = _row(trajectory, loaded)
    return kept


def swept_values(text: str) -> tuple[str, list[float | str]]:
    """Field and values of ``FIELD=FIRST:LAST:COUNT`` or ``FIELD=VALUE,VALUE,...``.

    Values between two ends that are written as whole numbers are such, if all are whole.

    Raises
    ------
    InputError
        If the text reads otherwise.

    Examples
    --------
    >>> from quasistatic_ref.lab.sweep import swept_values
    >>> swept_values("contacts.grip.mu_omega=0:0.04:5")
    ('contacts.grip.mu_omega', [0.0, 0.01, 0.02, 0.03, 0.04])
    >>> swept_values("steps=40:140:3")
    ('steps', [40, 90, 140])
    >>> swept_values("cone=pyramid,product")
    ('cone', ['pyramid', 'product'])
    """
    field, _, range_text = text.partition("=")
    first, *rest = range_text.split(":")
    try:
        if len(rest) == 2 and 1 <= int(rest[1]) <= MOST_RUNS:
            ends = float(first), float(rest[0])
            values: list[float | str] = [
                float(f"{v:.15g}") for v in np.linspace(*ends, int(rest[1])).tolist()
            ]
            whole_ends = all(map(WHOLE.fullmatch, (first, rest[0])))
            if whole_ends and not np.mod(values, 1).any():
                values = [int(value) for value in values]
            return field, values
    except ValueError:
        pass
    if not field or not range_text or rest:
        problem = "must read FIELD=FIRST:LAST:COUNT or FIELD=VALUE,VALUE,..."
        raise InputError(problem, field="--sweep", value=text)
    return field, [parsed(word) for word in range_text.split(",")]


def _value_list(name: str, values: Iterable[float | str]) -> list[Any]:
    """Values without repetitions, each a word or a finite number."""
    plain = [v.item() if isinstance(v, np.generic) else v for v in values]
    plain = [str(v) if isinstance(v, str) else v for v in plain]  # no word of a file of ours
    if not plain or not all(
        isinstance(v, str) or (isinstance(v, int | float) and abs(v) < LARGE) for v in plain
    ):
        raise InputError("must be a list of finite numbers or words", field=name, value=plain)
    return list(dict.fromkeys(plain))


def _changes(point: Mapping[str, Any], settings: Sequence[str]) -> list[str]:
    """One combination of values as changes of the scenario."""
    fields = []
    for name, value in point.items():
        for field in name.split(","):
            change = f"{field}={json_text(value)}"
            fields.append(OptionChange(change, change))
    return [*settings, *fields, 'record="light"', "fast=true"]


def check_scenario(scenario: str, changes: Sequence[str]) -> None:
    """Raise the InputError that a scenario with these changes, or its simulator, raises.

    What it has loaded is kept for the run, where that is in this process, as long as there is room.
    """
    loaded = load_scenario(scenario, changes)
    loaded.simulator()
    size = SCENE + sum(_size(side) for pair in loaded.pairs for side in (pair.alpha, pair.beta))
    if size + sum(each for each, _ in _loaded.values()) <= ROOM:
        _loaded[scenario, tuple(changes)] = size, loaded


def _size(placed: PlacedShape) -> int:
    """About how many bytes a shape takes."""
    return sum(x.nbytes for x in vars(placed.shape).values() if isinstance(x, np.ndarray))


def run_of(file: str, scenario: str, changes: Sequence[str]) -> tuple[str, Trajectory, Row]:
    """One run of a sweep: the name of its file, the trajectory, and its row of outcomes.

    Raises
    ------
    KeyboardInterrupt
        If the user ended it.
    """
    _, loaded = _loaded.pop((scenario, tuple(changes)), (0, None))
    loaded = loaded or load_scenario(scenario, changes)
    try:
        trajectory = loaded.run(progress=False, findings=False)
    except RunFailed as failure:
        if isinstance(failure.__cause__, KeyboardInterrupt):
            raise failure.__cause__ from None
        trajectory = failure.trajectory
    return file, trajectory, _row(trajectory, loaded)


def _row(trajectory: Trajectory, scenario: Scenario) -> Row:
    outcome = DONE if trajectory.failed is None else ENDED_EARLY
    outcome_fields = {"outcome": outcome, "reason": trajectory.failed}
    findings = [finding.name for finding in trajectory.findings]
    return outcome_fields | {
        "findings": findings,
        "not_looked_at": trajectory.header.not_looked_at,
        "measures": outcomes(trajectory, scenario),
    }


def outcomes(trajectory: Trajectory, scenario: Scenario) -> dict[str, float | None]:
    """Measured outcomes of one run.

    Parameters
    ----------
    trajectory : Trajectory
    scenario : Scenario
        Of which it is a run.

    Returns
    -------
    dict
        Numbers of its bodies, joints and pairs, :func:`.numbers.by_name`, ``boundary_layer_um``,
        ``quasi_dynamic_number``, ``steps`` and ``exact`` (share of steps certified exactly).
    """
    Pi = trajectory.header.quasi_dynamic_number
    exact = trajectory["certificate"] == "exact" if trajectory.steps else np.ones(1)
    return {
        **by_name(numbers_of(trajectory, scenario)),
        LAYER: 1e6 * (trajectory.header.largest_boundary_layer or 0.0),
        "quasi_dynamic_number": None if Pi is None else float(Pi),
        "steps": float(trajectory.steps),
        "exact": float(np.mean(exact)),
    }


ABOUT = ("outcome", "reason", "findings", "not_looked_at")


def _table(rows: Sequence[Row], names: Sequence[str]) -> str:
    """Return one line a run: its file, its values, what became of it, its measures of these names.

    The steps that were taken are named so, because `steps` may be a value.
    """
    named = ["steps_taken" if name == "steps" else name for name in names]
    head = ["run", *map(no_formula, rows[0]["values"]), *ABOUT, *map(no_formula, named)]
    return _lines([head, *(_cells(row, names) for row in rows)])


def _cells(row: Row, names: Sequence[str]) -> list[Any]:
    """The cells of a run in the table, with its measures of these names."""
    about = row | {"findings": "; ".join(row["findings"])}
    words = [row["run"], *row["values"].values(), *(about[word] for word in ABOUT)]
    safe = [no_formula(word) if isinstance(word, str) else word for word in words]
    return [*safe, *(row["measures"].get(name) for name in names)]


def _lines(cells: Iterable[Sequence[Any]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(cells)
    return text.getvalue()
