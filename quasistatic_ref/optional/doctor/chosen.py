"""Steps of a run that are looked at, from numbers that every record has."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.optional.doctor import slowly
from quasistatic_ref.optional.doctor.looks import TOUCHES
from quasistatic_ref.optional.doctor.start import slices
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.step.cones import cone

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Mask
    from quasistatic_ref.optional.doctor.run import Run

LITTLE = slowly.LITTLE
"""What a body drags over its own load, below which it is in equilibrium [-]."""
RISES = 0.03
"""What a layer may add to a force, and the part of friction lost to corners, that are asked [-]."""
PROVED = 60
"""Proofs after which no body is asked again, nor one that hardly moves."""


class Asked(NamedTuple):
    """A step that a body or a pair is looked at in.

    Parameters
    ----------
    score : float
        How much of it there is [-]: the largest first.
    name : str
        Of the body, or of the pair.
    k : int
    corners : bool
        Whether that is because of the corners of the cone.
    """

    score: float
    name: str
    k: int
    corners: bool = False


def asked(run: Run) -> list[Asked]:
    """All of them: the first of each body and pair, then the second of each."""
    every: dict[str, list[Asked]] = {}
    for one in (*_of_bodies(run), *_of_pairs(run)):
        every.setdefault(one.name, []).append(one)
    ranked = [sorted(each, key=lambda one: -one.score) for each in every.values()]
    order = [(i, -one.score, one) for each in ranked for i, one in enumerate(each)]
    return [one for *_, one in sorted(order, key=lambda x: x[:2])]


def _of_bodies(run: Run) -> list[Asked]:
    """Of each set of contacts that a body touches: where it drags most, and where it slips most."""
    near = run.presses | (run["phi"] <= TOUCHES * run.sizes)
    ways = np.linalg.norm(run.slips[..., :2], axis=-1)
    ways = np.where(run.presses & (ways > slowly.STICKS), ways, 0.0)
    steps_asked = []
    moves = run.targets_move & (np.arange(run.steps) > 0)
    for body in run.bodies_of:
        drags = run.drags[body] / run.loads[body]
        slips = ways[:, body.contacts].max(axis=1, initial=0.0)
        with np.errstate(all="ignore"):
            slips = slips * body.mass / run.h / run.h / run.loads[body]
        slips = np.where(np.isfinite(slips), slips, 0.0)
        sets = near[:, body.contacts]
        here = drags > LITTLE
        if body.free:
            here &= sets.any(axis=1)
        for score in (drags, slips, np.where(moves, drags, 0.0)):
            steps = np.flatnonzero(here & (score > LITTLE))
            of_set: dict[bytes, list[int]] = {}
            for k in steps.tolist():
                of_set.setdefault(sets[k].tobytes(), []).append(k)
            for each in of_set.values():
                k = _first(score[each])
                steps_asked.append(Asked(float(score[each[k]]), body.name, each[k]))
    return steps_asked


def _first(scores: Array) -> int:
    """The first of those that are the largest, up to a thousandth: equal steps are asked once."""
    return int((scores >= (1 - LITTLE) * scores.max()).argmax())


def _of_pairs(run: Run) -> list[Asked]:
    """Where the layer may add the largest share, and the largest force; where corners take most."""
    steps_asked = []
    s = np.where(run.presses, slip_norm(run.scaled_slips, run.simulator.cone), 0.0)
    gives = run.noted("gives")
    f_n = run["wrench"][:, :, 2]
    with np.errstate(all="ignore"):
        adds = np.where(run.presses & (gives > 0), s / gives, 0.0)
        shares = np.where(run.presses & (gives > 0), adds / f_n, 0.0)
    lost = _lost(run, s)
    convex = run.simulator.law == CONVEX
    for pair, of_pair in slices(run.pairs):
        stays = np.asarray(run.presses[:, of_pair].any(axis=1))
        stays[1:] &= stays[:-1].copy()  # not where it comes to press
        later = np.arange(run.steps) >= min(1, run.steps - 1)
        share = stays * later * shares[:, of_pair].max(axis=1, initial=0.0)
        most = np.minimum(adds, f_n)[:, of_pair].max(axis=1, initial=0.0)
        size = float(f_n[:, of_pair].max(initial=0.0))
        where = share > RISES
        if convex and where.any():
            steps_asked.append(Asked(float(share.max()), pair.name, _first(share)))
            most = np.where(where, most, 0.0)
            steps_asked.append(Asked(float(most.max()) / size, pair.name, _first(most)))
        corner = stays * (lost * f_n)[:, of_pair].max(axis=1, initial=0.0) / (size or 1.0)
        if corner.max(initial=0.0) > RISES:
            steps_asked.append(Asked(float(corner.max()), pair.name, _first(corner), True))
    if convex:
        for body in run.bodies_of:  # what slides below lifts against the spring above
            c = gives[:, body.contacts]
            stiff = np.where(c > 0, 1 / np.where(c > 0, c, 1.0), 0.0).max(axis=1, initial=0.0)
            loads = f_n[:, body.contacts].max(axis=1, initial=0.0)
            adds_up = s[:, body.contacts].max(axis=1, initial=0.0) * stiff
            share = np.divide(adds_up, loads, out=np.zeros_like(loads), where=loads > 0)
            if share.max(initial=0.0) > RISES:
                steps_asked.append(Asked(float(share.max()), body.name, _first(share)))
    return steps_asked


def _lost(run: Run, s: Array) -> Array:
    """Part of the friction that does no work along the slip, because of corners, (steps, n_c)."""
    name = run.simulator.cone
    if not cone(name).polyhedral or name == "frictionless":
        return np.zeros_like(s)
    scaled = run.scaled_slips
    length = np.linalg.norm(scaled, axis=-1)
    mu = run.mu
    f = run["wrench"][:, :, [0, 1, 3]] / np.where(mu > 0, mu, 1.0)
    moves: Mask = run.presses & (length > RISES * length.max(axis=0, initial=0.0)) & (length > 0)
    moves &= (np.abs(scaled) > slowly.STICKS).any(axis=-1)
    with np.errstate(all="ignore"):
        lost = 1 + np.vecdot(f, scaled) / (run["wrench"][:, :, 2] * length)
    return np.where(moves, lost, 0.0)


def looked(run: Run) -> int:
    """Look at the steps of a run; return how many were left out."""
    left = 0
    seen: set[tuple[str, int]] = set()
    known: set[str] = set()
    every = asked(run)
    far = {body.name for body in run.bodies_of if run.gets_far(body)}
    corners = {one.k for one in every if one.corners}
    for one in every:
        if (one.name, one.k) in seen:
            continue
        if run.looking.solvers.proved >= PROVED and one.name not in far - known:
            left += 1
            continue
        look = run.looking.at(one.k, one.name, one.k in corners)
        known.add(one.name)
        seen.add((one.name, one.k))
        of_look = look.bodies | look.lost
        known |= of_look
        seen |= {(name, one.k) for name in of_look}
    return left
