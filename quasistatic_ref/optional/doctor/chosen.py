"""Steps of a run that are looked at, from numbers that every record has."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.optional.doctor.artifacts import quotient
from quasistatic_ref.optional.doctor.slowly import LITTLE, STICKS
from quasistatic_ref.optional.doctor.start import slices
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.step.cones import cone

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Mask
    from quasistatic_ref.optional.doctor.run import Run

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


def _most(name: str, score: Array, least: float, corners: bool = False) -> Iterator[Asked]:
    """The step of the largest score, (steps,), of a body or pair, if that is beyond the least.

    It is the first of those that are the largest, up to a thousandth: equal steps are asked once.
    """
    largest = float(score.max(initial=0.0))
    if largest > least:
        k = int((score >= (1 - LITTLE) * largest).argmax())
        yield Asked(float(score[k]), name, k, corners)


def has_corners(name: str) -> bool:
    """Whether a cone has another friction in one direction than in another."""
    return cone(name).polyhedral and name != "frictionless"


def _of_bodies(run: Run) -> Iterator[Asked]:
    """Of each set of contacts that a body touches: where it drags most, and where it slips most."""
    ways = np.linalg.norm(run.slips[..., :2], axis=-1)
    ways = np.where(run.presses & (ways > STICKS), ways, 0.0)
    moves = run.targets_move & (np.arange(run.steps) > 0)
    for body in run.bodies_of:
        drags = run.drags[body] / run.loads[body]
        slips = body.mass * ways[:, body.contacts].max(axis=1, initial=0.0)
        slips = quotient(quotient(slips, run.h), run.h) / run.loads[body]
        touches = run.live[:, body.contacts]
        here = drags > LITTLE
        if body.free:
            here &= touches.any(axis=1)
        _, of_set = np.unique(touches, axis=0, return_inverse=True)
        for each in np.unique(of_set[here]):
            same = here & (of_set == each)
            for score in (drags, slips, moves * drags):
                yield from _most(body.name, same * score, LITTLE)


def _of_pairs(run: Run) -> Iterator[Asked]:
    """Where the layer may add the largest share, and the largest force; where corners take most."""
    s = np.where(run.presses, slip_norm(run.scaled_slips, run.simulator.cone), 0.0)
    f_n = run["wrench"][:, :, 2]
    gives = run.noted("gives") * (run.simulator.law == CONVEX)  # where none gives, no layer adds
    adds = quotient(s, gives)
    shares = quotient(adds, f_n)
    lost = _lost(run) * f_n
    later = np.arange(run.steps) >= min(1, run.steps - 1)
    for pair, of_pair in slices(run.pairs):
        stays = np.asarray(run.presses[:, of_pair].any(axis=1))
        stays[1:] &= stays[:-1].copy()  # not where it comes to press
        share = stays * later * shares[:, of_pair].max(axis=1, initial=0.0)
        most = np.minimum(adds, f_n)[:, of_pair].max(axis=1, initial=0.0) * (share > RISES)
        corner = stays * lost[:, of_pair].max(axis=1, initial=0.0)
        size = float(f_n[:, of_pair].max(initial=0.0)) or 1.0
        yield from _most(pair.name, share, RISES)
        yield from _most(pair.name, most / size, 0.0)
        yield from _most(pair.name, corner / size, RISES, corners=True)
    for body in run.bodies_of:  # what slides below lifts against the spring above
        stiff, loads, rises = (
            x[:, body.contacts].max(axis=1, initial=0.0) for x in (quotient(1.0, gives), f_n, s)
        )
        yield from _most(body.name, quotient(rises * stiff, loads), RISES)


def _lost(run: Run) -> Array:
    """Part of the friction that does no work along the slip, because of corners, (steps, n_c)."""
    scaled = run.scaled_slips
    length = np.linalg.norm(scaled, axis=-1)
    moves: Mask = run.presses & (length > RISES * length.max(axis=0, initial=0.0))
    moves &= (np.abs(scaled) > STICKS).any(axis=-1) & has_corners(run.simulator.cone)
    f = quotient(run["wrench"][:, :, [0, 1, 3]], run.mu)
    return moves * (1 + quotient(np.vecdot(f, scaled), run["wrench"][:, :, 2] * length))
