"""Contacts that do not touch: an optimum found without them is that of the step if they stay open.

Without the contacts that stay open, connected bodies fall into smaller groups: a heap into those
that press on each other. Which contacts these are is read from a backend's answer; that their rows
hold is proved here, from the minimisers of the groups in balls.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np
from flint import arb, ctx

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.minimiser import PRECISION
from quasistatic_ref.optional.fast.guess.confirm import (
    BallHessian,
    BallStep,
    all_nearest,
    contact_slacks,
)
from quasistatic_ref.step.data import Array, Indices, Mask, StepData

Solved: TypeAlias = "tuple[Indices, StepData, BallHessian, Sequence[int]]"
"""Of a group: its coordinates, its step, the H of that, and the working set of its optimum."""


def far_slacks(step: StepData, far: Indices, solved: Sequence[Solved]) -> tuple[Array, Mask]:
    """The slacks of the contacts that belong to no group, and which of these may not be open.

    Parameters
    ----------
    step : StepData
    far : ndarray of int, shape (k,)
        These contacts, ascending.
    solved : sequence of Solved
        All groups.

    Returns
    -------
    ndarray, shape (rows of these contacts,)
        Rounded correctly [m], if each of them is shown to be positive.
    ndarray of bool, shape (n_c,)
        The contacts of which a slack is not: of all where a minimiser is not shown.
    """
    place = np.full(step.contacts.n_c, -1)
    place[far] = np.arange(len(far))
    contact, coordinate, J = step.contacts.entries()
    counts = place[contact] >= 0
    columns = (place[contact][counts], coordinate[counts], J[counts])
    with ctx.workprec(PRECISION):
        x = [arb(0)] * step.n_v
        for coordinates, own, hessian, working in solved:
            found = BallStep(own, hessian).minimiser(working)
            if found is None:
                return np.zeros(0), np.ones(len(place), dtype=bool)
            for v, x_v in zip(coordinates.tolist(), found[2].entries(), strict=True):
                x[v] = x_v
        motion = [arb(0)] * (4 * len(far))
        for j, v, column in zip(*(given.tolist() for given in columns), strict=True):
            for i, entry in enumerate(column, start=4 * j):
                motion[i] += x[v] * entry
        slacks, shown = all_nearest(contact_slacks(step, far, motion))
    doubtful = np.zeros(len(place), dtype=bool)
    doubtful[np.repeat(far, step.counts[far])[~shown | (slacks <= 0)]] = True
    return slacks, doubtful


def with_far(step: StepData, optimum: ExactOptimum, near: Mask, slacks: Array) -> ExactOptimum:
    """An optimum with the `slacks` of the contacts that are not `near`, which are all positive.

    Parameters
    ----------
    step : StepData
    optimum : ExactOptimum
        With zeros in their places.
    near : ndarray of bool, shape (n_c,)
    slacks : ndarray, shape (rows of these contacts,)
        [m].
    """
    slack = optimum.slack.copy()
    slack[: step.offsets[-1]][np.repeat(~near, step.counts)] = slacks
    least = [s for s in (optimum.smallest_inactive_slack, slacks.min()) if s is not None]
    return replace(optimum, slack=slack, smallest_inactive_slack=float(min(least)))
