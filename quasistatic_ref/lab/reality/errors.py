"""How far predictions are from measurements, with bootstrap intervals."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.stats import bootstrap

from quasistatic_ref.lab.reality.measurements import Pushes
from quasistatic_ref.numbers.arrays import Array


def pose_errors(poses: Array, measured: Array) -> Array:
    """Distance of the frames' origins [m] and angle between them [rad], shape (n, 2).

    Parameters
    ----------
    poses, measured : ndarray, shape (n, 3)
        x, y [m], angle [rad].
    """
    gap = poses - measured
    turn = np.remainder(gap[:, 2] + np.pi, 2 * np.pi) - np.pi
    return np.column_stack([np.linalg.norm(gap[:, :2], axis=1), np.abs(turn)])


def estimate(groups: Sequence[Array]) -> dict[str, list[float]]:
    """The mean over groups of their means, and its 95 % interval: ``mean``, ``low``, ``high``.

    It is drawn with replacement inside of each group.

    Parameters
    ----------
    groups : sequence of ndarray, each of shape (n, columns)
        One for each pair [each column's unit].
    """

    def mean(*drawn: Array, axis: int) -> Array:
        means: Array = np.mean([group.mean(axis) for group in drawn], axis=0)
        return means

    low, high = bootstrap(groups, mean, n_resamples=2000, batch=100, method="percentile",
                          rng=0).confidence_interval  # fmt: skip
    return {"mean": mean(*groups, axis=0).tolist(), "low": low.tolist(), "high": high.tolist()}


def summary(poses: Mapping[str, Array], pushes: Mapping[str, Pushes]) -> dict[str, dict[str, Any]]:
    """Errors for each pair, and their mean over pairs under ``all``, as plain data.

    Each has ``pushes``, ``error``, ``moved``, ``published`` and ``more`` (error less that of the
    published simulator, push by push): each of the last four has ``mean``, ``low`` and ``high``,
    in mm and degrees.

    Parameters
    ----------
    poses : mapping of str to ndarray, shape (n, 3)
        Predictions by the name of the pair: x, y [m], angle [rad].
    pushes : mapping of str to Pushes
    """
    parts: dict[str, dict[str, Array]] = {}
    for name, measured in pushes.items():
        ends = {"error": poses[name], "moved": measured.before, "published": measured.published}
        parts[name] = {
            key: pose_errors(end, measured.after) * [1e3, np.degrees(1.0)]
            for key, end in ends.items()
        }
        parts[name]["more"] = parts[name]["error"] - parts[name]["published"]
    table: dict[str, dict[str, Any]] = {}
    for entry, names in {**{name: [name] for name in parts}, "all": list(parts)}.items():
        table[entry] = {"pushes": sum(len(poses[name]) for name in names)}
        for key in parts[names[0]]:
            table[entry][key] = estimate([parts[name][key] for name in names])
    return table
