"""Which kinks of the contacts' geometry the step after q feels."""

from collections.abc import Iterator
from functools import cache

import numpy as np

from quasistatic_ref.numbers.arrays import Mask
from quasistatic_ref.numbers.ordered import crossed
from quasistatic_ref.optional.derivatives.contact.jumps import jumps
from quasistatic_ref.optional.derivatives.contact.kinks import kinks
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.step.reason import Obstacle
from quasistatic_ref.optional.derivatives.step.touching import Touching
from quasistatic_ref.optional.derivatives.step_rates import StepRates
from quasistatic_ref.optional.friction import cone_matrix
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.cones import cone

FIELDS = ("dq_dq",)


def geometry_obstacles(
    simulator: Simulator, rates: StepRates, touching: Touching | None, safe: Mask
) -> list[Obstacle]:
    """The kinks that matter to the step: those of contacts that touch, or may where they jump to.

    Parameters
    ----------
    simulator : Simulator
    rates : StepRates
    touching : Touching or None
        The rows without slack; None if the step feels every contact, however far.
    safe : ndarray of bool, shape (n_c,)
        Contacts that it would not feel wherever they were.
    """
    step = rates.result.step
    contacts = step.contacts
    quarters = _quarters(simulator.cone)
    felt = range(contacts.n_c) if touching is None else touching.contacts
    obstacles = []
    for j, kind, says in kinks(rates.couples, rates.contacts, rates.motion.J, quarters):
        smooth = kind in reason.SMOOTH_POINTS
        if j not in felt and (smooth or safe[j]):
            continue
        frictionless = not contacts.mu[j, 0] or cone(simulator.cone).name == "frictionless"
        if kind == reason.TANGENTS and frictionless:
            continue
        blurred = kind != reason.CROSSING and rates.contacts.blurred[j]
        fields = tuple(rates.places) if blurred else FIELDS
        name = contacts.name[j]
        obstacles.append(rates.obstacle(kind, (name,), fields, f"{name} {says}"))
    return [*obstacles, *_jumps(simulator, rates, safe)]


def _jumps(simulator: Simulator, rates: StepRates, safe: Mask) -> Iterator[Obstacle]:
    """What other points a motion may bring in, pair by pair."""
    kept = rates.couples
    at = 0
    for pair in simulator.pairs:
        places = slice(at, at + pair.n_c)
        at += pair.n_c
        if safe[places].all():
            continue
        points = rates.result.points.chosen(np.arange(places.start, places.stop))
        for kind, where, says in jumps(kept[places], points, rates.motion.J):
            yield rates.obstacle(kind, where, FIELDS, says)


def out_of_reach(simulator: Simulator, rates: StepRates) -> Mask:
    """Contacts whose pair cannot close its distance in this step, whichever points it has.

    Parameters
    ----------
    simulator : Simulator
    rates : StepRates

    Returns
    -------
    ndarray of bool, shape (n_c,)
    """
    points = rates.result.points
    mu = rates.result.step.contacts.mu
    links = np.concatenate([simulator.layout.link_alpha, simulator.layout.link_beta])
    at = np.concatenate([points.alpha, points.beta])
    extents = np.array([couple.of.extents for couple in rates.couples]).reshape(-1, 2).T.ravel()
    twists = (rates.motion.J @ rates.x)[links]
    motion = np.linalg.norm(twists[:, :3] + crossed(twists[:, 3:], at), axis=1)
    turn = np.linalg.norm(twists[:, 3:], axis=1)
    turning = turn > 0  # any other point of the shape is this far from the end
    motion[turning] += np.sqrt(3) * turn[turning] * extents[turning]
    motion, turn = (both.reshape(2, -1).sum(axis=0) for both in (motion, turn))
    return np.asarray(points.phi > (1 + 2 * mu[:, 0]) * motion + mu[:, 2] * turn)


@cache
def _quarters(name: str) -> bool:
    """Whether a cone's rows are the same after a quarter turn about the normal."""
    rows = cone_matrix(name)
    turned = rows[:, [0, 2, 1, 3]] * [1, -1, 1, 1]
    return all(np.abs(rows - row).max(axis=1).min() < 1e-15 for row in turned)
