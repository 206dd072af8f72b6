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
from numpy.typing import NDArray

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.minimiser import PRECISION, equality_solution, form_in_balls
from quasistatic_ref.certify.rational import exact_form
from quasistatic_ref.certify.rounding import nearest_in
from quasistatic_ref.certify.slacks import KnownSlacks
from quasistatic_ref.step.cones import cone_function
from quasistatic_ref.step.data import Array, Indices, Mask, StepData

Balls: TypeAlias = list[arb]
Solved: TypeAlias = "tuple[Indices, StepData, Sequence[int]]"
"""Of a group: its coordinates, its step, and the working set of its optimum."""


def balls(x: Array, rest: Array, bound: Array) -> Balls:
    """Numbers x + rest within a bound, shape (n,) each, in balls [any unit]."""
    columns = zip(x.tolist(), rest.tolist(), bound.tolist(), strict=True)
    with ctx.workprec(PRECISION):
        return [arb(middle) + arb(more, radius) for middle, more, radius in columns]


def displacement(step: StepData, solved: Sequence[Solved]) -> Balls | None:
    """Balls about the exact delta_q of all groups, n_v [m, rad]; None if one is not shown."""
    x = [arb(0)] * step.n_v
    for coordinates, own, working in solved:
        form = exact_form(own)
        found = equality_solution(form_in_balls(form), working)
        if found is None:
            return None
        with ctx.workprec(PRECISION):
            for v, x_v in zip(coordinates.tolist(), found.x, strict=True):
                x[v] = x_v * form.x_unit
    return x


def far_slacks(step: StepData, far: Indices, x: Balls) -> tuple[Array, Mask]:
    """The slacks of the contacts that belong to no group, and which of these may not be open.

    Parameters
    ----------
    step : StepData
    far : ndarray of int, shape (k,)
        These contacts, ascending.
    x : list of arb, length n_v
        delta_q [m, rad].

    Returns
    -------
    ndarray, shape (rows of these contacts,)
        Rounded correctly [m], if each of them is shown to be positive.
    ndarray of bool, shape (n_c,)
        The contacts of which a slack is not.
    """
    place = np.full(step.contacts.n_c, -1)
    place[far] = np.arange(len(far))
    contact, coordinate, J = step.contacts.entries()
    counts = place[contact] >= 0
    columns = (place[contact][counts], coordinate[counts], J[counts])
    with ctx.workprec(PRECISION):
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
    return replace(optimum, slacks=KnownSlacks(slack), smallest_inactive_slack=float(min(least)))


def all_nearest(balls: Sequence[arb]) -> tuple[Array, NDArray[np.bool_]]:
    """The float64 nearest to every number in each ball, and whether it is shown to be.

    Returns
    -------
    ndarray, shape (balls,)
        The float64 numbers [of the unit of the balls].
    ndarray of bool, shape (balls,)
    """
    midpoints = [float(ball) for ball in balls]
    off = np.array([float((b - x).abs_upper()) for b, x in zip(balls, midpoints, strict=True)])
    x = np.array(midpoints) + 0.0  # never -0.0
    with np.errstate(over="ignore", invalid="ignore"):
        gap = np.minimum(np.nextafter(x, np.inf) - x, x - np.nextafter(x, -np.inf))
    # gap / 2 is a float64 (0 of the least gap): an error that is not below it is not rounded to a
    # number below it.
    shown = (off < gap / 2) | (off == 0) & (x == 0)
    for i in np.flatnonzero(~shown & (off <= 2 * gap)).tolist():  # a power of two, or subnormal
        value = nearest_in(balls[i])
        x[i], shown[i] = (x[i], False) if value is None else (value, True)
    return x, shown


def contact_slacks(step: StepData, which: Sequence[int] | Indices, motion: list[arb]) -> list[arb]:
    """A x - b of the rows of some contacts: the cone's function of gap, slip and spin.

    Parameters
    ----------
    step : StepData
    which : sequence of int
        The contacts.
    motion : list of arb, length 4 len(which)
        J x of these [m, m, m, rad].
    """
    contacts = step.contacts
    rows = cone_function(step.cone)
    j = [*which]
    numbers = (contacts.phi, contacts.n, contacts.d1, contacts.d2, contacts.mu, step.counts)
    found = list[arb]()
    for i, (phi, n, d1, d2, (mu_v, _, mu_omega), count) in enumerate(
        zip(*(given[j].tolist() for given in numbers), strict=True)
    ):
        nu = motion[4 * i : 4 * i + 3]
        spin = motion[4 * i + 3]
        gap = _dot(n, nu) + phi
        slip_1 = _dot(d1, nu) * mu_v
        slip_2 = _dot(d2, nu) * mu_v
        found += rows(gap, slip_1, slip_2, spin * mu_omega)[:count]  # Eq. (4)
    return found


def _dot(direction: list[float], nu: list[arb]) -> arb:
    return nu[0] * direction[0] + nu[1] * direction[1] + nu[2] * direction[2]
