"""How far predictions are from measurements, with bootstrap intervals."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.lab.reality.pushes import Pushes
from quasistatic_ref.step.data import Array

DRAWS = 2000
"""Of a bootstrap."""


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


@dataclass(frozen=True, eq=False)
class Estimate:
    """A mean with its 95 % interval.

    Parameters
    ----------
    mean, low, high : ndarray, shape (columns,)
        [each column's unit].
    """

    mean: Array
    low: Array
    high: Array


def bootstrap_estimate(groups: Sequence[Array]) -> Estimate:
    """The mean over groups of their means; drawn with replacement inside of each group.

    Parameters
    ----------
    groups : sequence of ndarray, each of shape (n, columns)
        One for each pair [each column's unit].
    """
    rng = np.random.default_rng(0)
    drawn = np.zeros((DRAWS, groups[0].shape[1]))
    for group in groups:
        n = len(group)
        counts = rng.multinomial(n, np.full(n, 1 / n), size=DRAWS)
        drawn += counts @ group / n
    low, high = np.quantile(drawn / len(groups), [0.025, 0.975], axis=0)
    return Estimate(np.mean([group.mean(0) for group in groups], axis=0), low, high)


@dataclass(frozen=True, eq=False)
class Errors:
    """Of the pushes of one pair, in mm and degrees.

    Parameters
    ----------
    model, moved : ndarray, shape (n, 2)
        Of the prediction; how far the object moved [mm, deg].
    published : ndarray, shape (n, 2), or None
        Of a published simulator [mm, deg].
    """

    model: Array
    moved: Array
    published: Array | None


def errors_of(poses: Array, pushes: Pushes) -> Errors:
    """The errors of predicted poses, shape (n, 3) [m, rad], of the pushes of a pair."""
    units = np.array([1e3, np.degrees(1.0)])
    other = None
    if pushes.published is not None:
        other = units * pose_errors(pushes.published, pushes.after)
    return Errors(
        units * pose_errors(poses, pushes.after),
        units * pose_errors(pushes.before, pushes.after),
        other,
    )


def summary(errors: Mapping[str, Errors]) -> dict[str, dict[str, object]]:
    """One entry for each pair and one, ``all``, for the mean over pairs: plain data.

    Each has ``pushes`` and, where they are known, ``error``, ``moved``, ``published`` and ``more``
    (error less that of the published simulator, push by push): each three pairs (mm, degrees) of
    mean, low and high.
    """
    groups = {name: [group] for name, group in errors.items()} | {"all": list(errors.values())}
    table = {}
    for name, group in groups.items():
        entry: dict[str, object] = {"pushes": sum(len(e.model) for e in group)}
        parts = {"error": [e.model for e in group], "moved": [e.moved for e in group]}
        others = [e.published for e in group if e.published is not None]
        if len(others) == len(group):
            parts["published"] = others
            parts["more"] = [e.model - o for e, o in zip(group, others, strict=True)]
        for key, values in parts.items():
            entry[key] = {of: x.tolist() for of, x in vars(bootstrap_estimate(values)).items()}
        table[name] = entry
    return table
