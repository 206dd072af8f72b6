"""Many runs of one scenario at once: the sweep's machinery, without a study file."""

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.study.measuring.sweep import (
    MOST_RUNS,
    Axis,
    Sweep,
    is_value,
    run_file,
    run_sweep,
)
from quasistatic_ref.lab.study.store.rows import Row
from quasistatic_ref.scenario.overrides import parsed

TABLE = "runs.csv"


def simulate_many(
    scenario: str | Path,
    variations: Mapping[str, Iterable[float | str]],
    folder: str | Path,
    *,
    settings: Sequence[str] = (),
    workers: int | None = None,
    scheduler: str | None = None,
    progress: bool = True,
) -> list[Row]:
    """Run a scenario with every combination of some values, several runs at a time.

    Parameters
    ----------
    scenario : str or Path
        A name, or a file.
    variations : mapping of str to iterable of float or str
        Dotted field of the scenario -> its values [the field's unit]; of several fields with the
        same values, their names with commas between.
    folder : str or Path
        For ``runs.csv``, one line a run; ``runs/*.npz``, one light trajectory a run; and
        ``study.sqlite``, from which the same call goes on after an interruption.
    settings : sequence of str
        Changes of the scenario that all runs have, as :func:`.load_scenario` takes them.
    workers : int, optional
        Processes on this machine; by default as many as there are cores.
    scheduler : str, optional
        Address of a Dask scheduler, in place of this machine's processes.
    progress : bool

    Returns
    -------
    list of dict
        One row a run, sorted: ``values``, ``outcome``, ``reason``, ``measures``.

    Raises
    ------
    InputError
        If a field, a value or any of the scenarios is unusable, or the folder holds other runs:
        before anything is written.
    """
    axes = tuple(_axis(name, values) for name, values in variations.items())
    count = math.prod(len(axis.values) for axis in axes)
    if not axes or count > MOST_RUNS:
        problem = f"must make 1 to {MOST_RUNS} runs"
        raise InputError(problem, field="variations", value=count if axes else 0)
    if workers is not None and workers < 1:
        raise InputError("must be at least 1", field="workers", value=workers)
    path = str(Path(scenario).resolve()) if str(scenario).endswith(".toml") else str(scenario)
    sweep = Sweep(Path(path).stem, path, None, axes, tuple(settings))
    rows = run_sweep([sweep], folder, jobs=workers, scheduler=scheduler, progress=progress)
    text_written(Path(folder) / TABLE, _table(rows))
    return rows


def swept_values(text: str) -> tuple[str, list[float | str]]:
    """Field and values of ``FIELD=FIRST:LAST:COUNT`` or ``FIELD=VALUE,VALUE,...``.

    Raises
    ------
    InputError
        If the text reads otherwise.

    Examples
    --------
    >>> from quasistatic_ref.lab.study.measuring.many import swept_values
    >>> swept_values("contacts.grip.mu_omega=0:0.04:5")
    ('contacts.grip.mu_omega', [0.0, 0.01, 0.02, 0.03, 0.04])
    >>> swept_values("cone=pyramid,product")
    ('cone', ['pyramid', 'product'])
    """
    field, _, given = text.partition("=")
    first, *rest = given.split(":")
    try:
        if len(rest) == 2 and 1 <= int(rest[1]) <= MOST_RUNS:
            ends = float(first), float(rest[0])
            return field, [float(f"{v:.15g}") for v in np.linspace(*ends, int(rest[1])).tolist()]
    except ValueError:
        pass
    if not field or not given or rest:
        problem = "must read FIELD=FIRST:LAST:COUNT or FIELD=VALUE,VALUE,..."
        raise InputError(problem, field="--sweep", value=text)
    return field, [parsed(word) for word in given.split(",")]


def _axis(name: str, values: Iterable[float | str]) -> Axis:
    own = [v.item() if isinstance(v, np.generic) else v for v in values]
    own = [str(v) if isinstance(v, str) else v for v in own]  # no word of a file of ours
    if not own or not all(map(is_value, own)):
        raise InputError("must be a list of finite numbers or words", field=name, value=own)
    return Axis(name, tuple(name.split(",")), tuple(dict.fromkeys(own)))


def _table(rows: Sequence[Row]) -> str:
    """Return one line a run: its file, its values, what became of it.

    The steps that were taken are named so, because `steps` may be a value.
    """
    measures = list(dict.fromkeys(name for row in rows for name in row["measures"]))
    named = ["steps_taken" if name == "steps" else name for name in measures]
    text = io.StringIO()
    lines = csv.writer(text, lineterminator="\n")
    lines.writerow(["run", *rows[0]["values"], "outcome", "reason", *named])
    for row in rows:
        found: list[Any] = [row["measures"].get(name) for name in measures]
        lines.writerow([run_file(row), *row["values"].values(), row["outcome"], row["reason"],
                        *found])  # fmt: skip
    return text.getvalue()
