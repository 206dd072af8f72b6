"""All pushes of some pairs, predicted with friction that is identified from their loads."""

from collections.abc import Sequence
from concurrent.futures import Executor
from functools import partial
from typing import Any

from quasistatic_ref.lab.reality.identify import identified_ratio
from quasistatic_ref.lab.reality.measurements import Pair, loads_read, pushes_read
from quasistatic_ref.lab.reality.predict import Prediction, prediction
from quasistatic_ref.lab.reality.push import pushed_scene
from quasistatic_ref.lab.reality.report import reality_record
from quasistatic_ref.lab.reality.settings import Settings
from quasistatic_ref.simulate.progress import progress_bar

PROOFS = ("exact", "enclosure")
"""Kinds of certificates."""


def predicted_pushes(
    settings: Settings,
    pairs: Sequence[Pair],
    every: int,
    executor: Executor | None = None,
    *,
    progress: bool = False,
) -> tuple[dict[str, Any], dict[str, list[Prediction]]]:
    """The record of what predictions came to, and the predictions of each pair.

    Parameters
    ----------
    settings : Settings
    pairs : sequence of Pair
    every : int
        1: all pushes; 2: every second of each pair.
    executor : Executor, optional
        What makes several predictions at once.
    progress : bool
        Whether to show bars on standard error, where that is a terminal.
    """
    loads = loads_read(pairs)
    ratios = {p.name: identified_ratio(loads[p.name], p.outline.gyration) for p in pairs}
    pushes = {key: value.every(every) for key, value in pushes_read(pairs).items()}
    many = map if executor is None else partial(executor.map, chunksize=5)
    under_way = {}
    for pair in pairs:
        predict = partial(prediction, pushed_scene(settings, pair, ratios[pair.name]))
        some = pushes[pair.name]
        under_way[pair.name] = many(predict, some.before, some.path)
    ends = {
        key: list(progress_bar(predictions, total=len(pushes[key].before), words=key,
                               unit="push", shown=progress))
        for key, predictions in under_way.items()
    }  # fmt: skip
    return reality_record(settings, ratios, every, pushes, ends), ends
