"""Many pushes predicted in parallel, each kept in a file as soon as it is known.

The file has a first line with the settings, and one line a push. A run that was ended goes
on from there; a last line that was cut off is dropped.
"""

from collections.abc import Hashable, Iterator, Mapping, Sequence
from os import cpu_count
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.lab.log import Log
from quasistatic_ref.lab.parallel import results, workers
from quasistatic_ref.lab.reality.pairs import Pair
from quasistatic_ref.lab.reality.predict import prediction
from quasistatic_ref.lab.reality.push import Pushed, pushed_scene
from quasistatic_ref.lab.reality.pushes import Pushes
from quasistatic_ref.lab.reality.settings import Settings
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.step.data import Array

FORMAT = {"format": "quasistatic-ref/reality", "version": 1}
CHUNK = 5
"""Pushes handed to a process at once: some seconds of work."""

Row = dict[str, Any]


def predicted_pushes(
    pairs: Sequence[Pair],
    pushes: Mapping[str, Pushes],
    ratios: Mapping[str, float],
    settings: Settings,
    path: Path,
    *,
    jobs: int | None = None,
    progress: bool = True,
) -> dict[str, list[Row]]:
    """Predict pushes, or what is left of them.

    Parameters
    ----------
    pairs : sequence of Pair
    pushes : mapping of str to Pushes
        By the name of the pair.
    ratios : mapping of str to float
        mu_omega / mu_v of each pair [m].
    settings : Settings
    path : Path
        Where rows are kept.
    jobs : int, optional
        Processes; by default as many as there are cores. With 1 it is this one.
    progress : bool

    Returns
    -------
    dict of str to list of dict
        One row a push, in the order of ``pushes``, by the name of the pair.

    Raises
    ------
    InputError
        If the file holds a run of other settings, or is none.
    StepNotSolved
        If a step has no answer that can be trusted.
    """
    scenes = {pair.name: pushed_scene(settings, pair, ratios[pair.name]) for pair in pairs}
    header = FORMAT | {
        "settings": settings.record(),
        "mu_omega_over_mu_v": {pair.name: float(ratios[pair.name]) for pair in pairs},
    }
    log = Log(path, lambda row: (row["pair"], row["push"]), header)
    chunks = list(_chunks(pairs, pushes, log.by_key))
    calls = [(name, scenes[name], tasks) for name, tasks in chunks]
    total = sum(pushes[pair.name].number.size for pair in pairs)
    left = sum(len(tasks) for _, tasks in chunks)
    jobs = min(jobs or cpu_count() or 1, max(1, len(chunks)))
    with (
        workers(jobs) as executor,
        progress_bar(total=total, done=total - left, unit="push", shown=progress) as bar,
    ):
        for rows in results(executor, 2 * jobs - 1, rows_of, calls):
            log.add(*rows)
            bar.update(len(rows))
    return {
        pair.name: [log.by_key[pair.name, int(k)] for k in pushes[pair.name].number]
        for pair in pairs
    }


Chunk = tuple[str, list[tuple[int, Array, Array]]]


def _chunks(
    pairs: Sequence[Pair], pushes: Mapping[str, Pushes], done: Mapping[Hashable, Row]
) -> Iterator[Chunk]:
    for pair in pairs:
        of_pair = pushes[pair.name]
        every = zip(of_pair.number.tolist(), of_pair.before, of_pair.path, strict=True)
        left = [task for task in every if (pair.name, task[0]) not in done]
        for k in range(0, len(left), CHUNK):
            yield pair.name, left[k : k + CHUNK]


def rows_of(name: str, scene: Pushed, tasks: Sequence[tuple[int, Array, Array]]) -> list[Row]:
    """Predict some pushes of a pair.

    Parameters
    ----------
    name : str
        Of the pair.
    scene : Pushed
    tasks : sequence of (int, ndarray of shape (3,), ndarray of shape (n, 2))
        Number, pose before [m, rad] and path of the finger [m] of each.
    """
    rows = []
    for number, pose, path in tasks:
        end = prediction(scene, pose, path)
        rows.append({
            "pair": name, "push": number, "pose": end.pose, "steps": end.kinds,
            "error_bound": end.error_bound, "sticks": end.sticks, "slides": end.slides,
        })  # fmt: skip
    return rows


def poses(rows: Sequence[Row]) -> Array:
    """Predicted poses, shape (n, 3): x, y [m], angle [rad]."""
    return np.array([row["pose"] for row in rows])
