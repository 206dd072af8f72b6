"""The noise of a study's times: measurements that were made twice, at different moments."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.lab.study.report.columns import Columns, chosen, groups, size
from quasistatic_ref.lab.study.report.statistics import shifted_geometric_mean

FEWEST = 5
"""Pairs of one solver from which a mean is given."""
MOST_OF = 90.0
"""The percentile of solvers that the floor is [%]."""


@dataclass(frozen=True)
class Noise:
    """How far two measurements of the same call differ.

    Parameters
    ----------
    pairs : int
        Measurements that were solved twice.
    call : float or None
        Median of |t_1 / t_2 - 1| of one measurement [-].
    floor : float or None
        Of the shifted geometric mean of a solver's times, the 90th percentile of solvers [-]:
        smaller differences between solvers are ties. None where nothing was measured twice.
    """

    pairs: int
    call: float | None
    floor: float | None


def noise_of(columns: Columns) -> Noise:
    """The noise of a study, from its rows of repetitions 0 and 1."""
    solved = {name: column[columns["solved"]] for name, column in columns.items()}
    first, again = (chosen(solved, {"repetition": r}) for r in (0, 1))
    keys = [_keys(part) for part in (first, again)]
    _, one, two = np.intersect1d(keys[0], keys[1], return_indices=True)
    if not len(one):
        return Noise(0, None, None)
    before, after = first["seconds"][one], again["seconds"][two]
    own = {
        "unit": first["unit"][one],
        "label": first["label"][one],
        "before": before,
        "after": after,
    }
    spread = np.exp(abs(np.log(before) - np.log(after))) - 1
    means = [
        abs(np.log(shifted_geometric_mean(p["before"]) / shifted_geometric_mean(p["after"])))
        for _, p in groups(own, ["label"])
        if len(p["label"]) >= FEWEST
    ]
    floor = float(np.exp(np.percentile(means, MOST_OF)) - 1) if means else None
    return Noise(len(one), float(np.median(spread)), floor)


def noise_words(noise: Noise) -> str:
    """The noise as a sentence."""
    if noise.floor is None or noise.call is None:
        return (
            "No measurement was repeated, or too few were: the noise of these times is not known, "
            "and no difference is called a tie."
        )
    return (
        f"{noise.pairs:,} measurements were repeated after all others. The two times of a "
        f"measurement differ by {100 * noise.call:.0f} % (median), the two mean times of a solver "
        f"by at most {100 * noise.floor:.0f} % for nine solvers of ten. Solvers that differ by "
        "less are tied."
    )


def _keys(part: Columns) -> np.ndarray:
    names: Sequence[str] = ("label", "problem", "setting", "units")
    rows = zip(*(part[name] for name in names), part["warm"].astype(str), strict=True)
    keys = ["\n".join(row) for row in rows]
    return np.array(keys, dtype=np.str_) if size(part) else np.zeros(0, dtype=np.str_)
