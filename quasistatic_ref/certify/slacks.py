"""The slacks of an optimum, which few steps read: formed and rounded when they are."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from quasistatic_ref.certify.step_minimiser import StepMinimiser
from quasistatic_ref.step.data import Array, Indices


class Slacks(Protocol):
    """All slacks of an optimum."""

    @property
    def values(self) -> Array:
        """A delta_q - b, each rounded correctly, shape (m,) [m]."""


@dataclass(frozen=True, eq=False)
class KnownSlacks:
    """Slacks that are formed already.

    Parameters
    ----------
    values : ndarray, shape (m,)
        [m].
    """

    values: Array


class StepSlacks:
    """The slacks at a minimiser on a working set whose signs are decided.

    Parameters
    ----------
    minimiser : StepMinimiser
    """

    def __init__(self, minimiser: StepMinimiser) -> None:
        self.minimiser = minimiser

    @cached_property
    def inactive(self) -> Indices:
        """The rows whose slacks are not zero."""
        minimiser = self.minimiser
        zero = [i for i, sign in minimiser.slack_signs.items() if sign == 0]
        is_tight = np.zeros(minimiser.form.m, dtype=bool)
        is_tight[[*minimiser.working, *minimiser.spanned, *zero]] = True
        return np.flatnonzero(~is_tight)

    @cached_property
    def values(self) -> Array:
        """See :class:`Slacks`; shape (m,) [m]."""
        slack = np.zeros(self.minimiser.form.m)
        slack[self.inactive] = self._rounded(self.inactive)
        return slack

    @cached_property
    def smallest(self) -> float | None:
        """The smallest slack that is not zero, rounded [m]; None if there is none.

        Rounding keeps the order, so it is the least of the rounded ones: of those that float64 and
        its bound leave the chance to be it.
        """
        if not self.inactive.size:
            return None
        slack, error = (numbers[self.inactive] for numbers in self.minimiser.float_slacks)
        near = self.inactive[~(slack - error > (slack + error).min())]
        return float(self._rounded(near).min())

    def _rounded(self, rows: Indices) -> Array:
        form = self.minimiser.form
        return self.minimiser.rounded(lambda found: form.slacks(rows.tolist(), found.z))


class JoinedSlacks:
    """The slacks of a step from those of its groups.

    Parameters
    ----------
    m : int
        Number of all rows.
    parts : sequence of (ndarray, Slacks)
        The rows of each group, and their slacks.
    """

    def __init__(self, m: int, parts: Sequence[tuple[Indices, Slacks]]) -> None:
        self.m = m
        self.parts = parts

    @cached_property
    def values(self) -> Array:
        """See :class:`Slacks`; shape (m,) [m]."""
        slack = np.zeros(self.m)
        for rows, slacks in self.parts:
            slack[rows] = slacks.values
        return slack
