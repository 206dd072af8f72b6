"""What the prediction of pushes came to, as plain data and as tables."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.lab.reality.errors import summary
from quasistatic_ref.lab.reality.measurements import Pushes
from quasistatic_ref.lab.reality.predict import Prediction
from quasistatic_ref.lab.reality.settings import Settings

Ends = Mapping[str, Sequence[Prediction]]
"""By the name of the pair, in the order of its pushes."""


def reality_record(
    settings: Settings, ratios: Mapping[str, float], every: int, pushes: Mapping[str, Pushes],
    ends: Ends,
) -> dict[str, Any]:  # fmt: skip
    """Settings, errors by pair and pooled, and how steps were certified: plain data.

    Parameters
    ----------
    settings : Settings
    ratios : mapping of str to float
        mu_omega / mu_v of each pair [m].
    every : int
        1: all pushes; 2: every second of each pair.
    pushes : mapping of str to Pushes
    ends : mapping of str to sequence of Prediction
    """
    flat = [end for of_pair in ends.values() for end in of_pair]
    kinds = sum((Counter(end.kinds) for end in flat), Counter[str]())
    bounds = [end.error_bound for end in flat if end.error_bound is not None]
    poses = {name: np.array([end.pose for end in of_pair]) for name, of_pair in ends.items()}
    return {
        "format": "quasistatic-ref/reality-summary",
        "version": 1,
        "settings": settings.record(),
        "mu_omega_over_mu_v": dict(ratios),
        "steps": dict(sorted(kinds.items())),
        "largest_error_bound": max(bounds) if len(bounds) == len(flat) else None,
        "pairs": summary(poses, pushes),
        "every": every,
    }


def predictions_text(ends: Ends, every: int) -> str:
    """The predictions as CSV, seven digits: poses [m, rad], steps by certificate and by grip."""
    lines = ["surface,shape,push,x1,y1,theta1,exact,enclosure,sticks,slides"]
    for name, of_pair in ends.items():
        for k, end in enumerate(of_pair):
            pose = ",".join(f"{x:.7g}" for x in end.pose)
            steps = ",".join(str(end.kinds.get(kind, 0)) for kind in ("exact", "enclosure"))
            grip = f"{end.sticks},{end.slides}"
            lines.append(f"{name.replace('/', ',')},{every * k},{pose},{steps},{grip}")
    return "\n".join([*lines, ""])


def error_rows(record: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """The table of a record: one line a pair, the mean over pairs last."""
    table: list[tuple[str, ...]] = [
        ("pair", "pushes", "mu_omega / mu_v [mm]", "moved [mm]", "[deg]", "error [mm]", "95 %",
         "[deg]", "95 %", "published [mm]", "[deg]")
    ]  # fmt: skip
    for name, entry in record["pairs"].items():
        ratio = record["mu_omega_over_mu_v"].get(name)
        cells = [name, f"{entry['pushes']:,}", "-" if ratio is None else f"{1e3 * ratio:.1f}"]
        cells += [f"{x:.1f}" for x in entry["moved"]["mean"]]
        for low, mean, high in zip(*(entry["error"][k] for k in ENDS), strict=True):
            cells += [f"{mean:.2f}", f"{low:.2f} - {high:.2f}"]
        table.append((*cells, *(f"{x:.2f}" for x in entry["published"]["mean"])))
    return table


ENDS = ("low", "mean", "high")
"""Of an interval, and what is in it."""


def certified_words(record: Mapping[str, Any]) -> str:
    """One sentence on how the steps were certified."""
    kinds = record["steps"]
    counts = ", ".join(f"{count:,} {kind}" for kind, count in kinds.items())
    bound = record["largest_error_bound"]
    words = "some have no error bound" if bound is None else f"the largest error is {bound:.1e}"
    return f"{sum(kinds.values()):,} steps: {counts}; {words}"
