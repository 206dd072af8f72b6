"""What drag and the boundary layer add to the forces of pairs, read from the record of a run.

Drag M v / h of a free body is borne by the pairs that push along it, by their shares, and is
missing in those that it pushes against. That of a drawer or a door is borne by power. A spring
presses by the layer s over what it gives.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.did.artifacts import LIGHT, drag, quotient
from quasistatic_ref.optional.doctor.frame.hinged import hinged, sides
from quasistatic_ref.optional.doctor.frame.run import Run, in_world
from quasistatic_ref.optional.doctor.frame.start import SHORT
from quasistatic_ref.optional.doctor.texts import finding
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import CONVEX

COUNTS = 0.1
"""Part of a pair's largest force from which on it is said [-]."""
FACES = -0.5
"""Cosine between a normal force and a motion that it stops [-]."""
NEARLY = 0.95
"""Part of the largest share of a pair [-] from which on steps say the same: the last counts."""
TOLD = 0.1
"""Part of the larger of drag and layer from which on the other is said, too [-]."""


class Added(NamedTuple):
    """How much drag and boundary layer add to the force of a pair in a step.

    Parameters
    ----------
    share : float
        Of the pair's largest force [-].
    k, pair : int
    here, drag, layer : float
        Its force, and what of it is about added [N].
    """

    share: float
    k: int
    pair: int
    here: float
    drag: float
    layer: float


def artifact(run: Run) -> Iterator[Finding]:
    """The pair to which drag and the layer add most, if it is a tenth of its force."""
    most = max(added(run), default=None)
    if most is None or most.share <= COUNTS:
        return
    pair = run.pairs[most.pair].name
    least = TOLD * max(abs(most.drag), most.layer)
    parts = [(most.drag, "drag"), (most.layer, "the boundary layer")]
    how = f"of which {' and '.join(f'about {x:.3g} N by {what}' for x, what in parts if x > least)}"
    if most.drag < -least:
        how = f"for about {most.here - most.drag:.3g} N: {-most.drag:.3g} N are borne by drag"
    remedy = "move more slowly, or take a larger h"
    if abs(most.drag) < most.layer:
        remedy = 'move more slowly, take a smaller h, or set law = "coulomb"'
    numbers = {"run_N": most.here, "slowly_N": most.here - most.drag - most.layer}
    numbers |= {"drag_N": most.drag, "layer_N": most.layer, "step": most.k}
    cause = f"{pair} has {most.here:.3g} N, {how} (step {most.k})"
    yield finding("artifact", cause, remedy, pair.partition("(")[0], **numbers)


def largest_drag(run: Run) -> str:
    """The drag of the pair in which it is most: ``; drag about 0.5 of 2.46 N at push``."""
    most = max(added(run), key=lambda one: abs(one.drag), default=None)
    if most is None or abs(most.drag) <= LIGHT * most.here:
        return ""
    name = run.pairs[most.pair].name.partition("(")[0]
    return f"; drag about {abs(most.drag):.2g} of {most.here:.3g} N at {name}"


def added(run: Run) -> Iterator[Added]:
    """For each pair, the most that drag or layer adds to its force while targets or loads move.

    A layer of what slips because it falls comes of the fall.
    """
    if not run.pairs:
        return
    f = run["wrench"]
    normal = f[..., 2:3] * run["n"]
    tangential = f[..., :1] * run["d1"] + f[..., 1:2] * run["d2"]
    every, pushed = (run.of_pairs(np.add, x).swapaxes(0, 1) for x in (normal + tangential, normal))
    by_drag, along = _drags(run, every, pushed)
    of_joints = _drags_of_joints(run, normal + tangential)
    larger = np.abs(of_joints[0]) > np.abs(by_drag)
    by_drag, along = np.where(larger, of_joints, (by_drag, along))
    layer = layers(run)
    for name, base in run.free_bases.items():
        layer[np.ix_(run.falls(base), run.of_body(name))] = 0.0
    on = run.of_pairs(np.logical_or, run.touches)
    before = np.vstack([np.full_like(on[:1], run.steps == 1), on[:-1]])
    stays = (on & before).T & (run.targets_move | run.loads_move)
    pressed = np.linalg.norm(pushed, axis=2)
    size = run.sizes[[of.start for _, of in run.slices]]
    lands = (run.of_pairs(np.maximum, run["phi"]) > SHORT * size).T
    by_drag = np.where(lands, np.maximum(by_drag, 0.0), by_drag)
    by_layer = np.minimum(run.of_pairs(np.maximum, layer).T, pressed)
    parts = np.array([by_drag, by_layer]) * stays
    here = np.where(np.abs(parts[0]) >= parts[1], along, pressed)
    largest = run.of_pairs(np.add, f[min(1, run.steps - 1) :, :, 2]).max(axis=0)
    whole = np.maximum(largest, np.maximum(here, here - parts[0]).max(axis=1))
    shares = quotient(np.abs(parts).max(axis=0), whole[:, None])
    nearly = shares >= NEARLY * shares.max(axis=1, keepdims=True)
    last = run.steps - 1 - nearly[:, ::-1].argmax(axis=1)
    for i, k in enumerate(last.tolist()):
        yield Added(float(shares[i, k]), k, i, float(here[i, k]), *map(float, parts[:, i, k]))


def layers(run: Run) -> Array:
    """Force that the boundary layer may add at each contact, shape (steps, n_c) [N]."""
    s = np.where(run.touches, run.sliding, 0.0)
    return quotient(s, run.noted("gives")) * (run.simulator.law == CONVEX)


def _drags(run: Run, every: Array, normal: Array) -> tuple[Array, Array]:
    """What drag changes in the force of each pair, and that force along it, (pairs, steps) [N].

    Parameters
    ----------
    run : Run
    every, normal : ndarray, shape (pairs, steps, 3)
        The force on beta, and what of it is normal [N]: friction at its limit takes no more.
    """
    changes, forces = np.zeros((2, *every.shape[:2]))
    bases = [*run.free_bases.values()]
    at = [(i, which) for i, name in enumerate(run.free_bases) for which in run.numbers_of(name)]
    if not at:
        return changes, forces
    body, pair = np.transpose(at)
    starts = np.diff(body, prepend=-1) > 0
    first = np.flatnonzero(starts)
    group = np.cumsum(starts) - 1
    link = np.array([run.system.link(name) for name in run.free_bases])[body]
    beta, alpha = (np.array([getattr(x, of).link for x in run.pairs]) for of in ("beta", "alpha"))
    signs = 1.0 * (beta[pair] == link) - (alpha[pair] == link)
    quaternions = np.array([run["q"][:-1, base.q][:, 3:] for base in bases])
    F = in_world(quaternions, np.array([drag(run, base) for base in bases]))[body]
    size = np.linalg.norm(F, axis=2)
    force, pressed = (
        signs[:, None] * quotient(np.einsum("pkx,pkx->pk", f[pair], F), size)
        for f in (every, normal)
    )

    def share(of_pairs: Array) -> Array:
        """What each pair has of drag, by its part of what the pairs of a body have."""
        whole = np.add.reduceat(of_pairs, first, axis=0)
        return np.asarray(size * quotient(of_pairs, whole[group]))

    along = np.maximum(force, 0.0)
    faces = pressed < FACES * np.linalg.norm(normal[pair], axis=2)
    against = np.where(faces, -pressed, 0.0)
    helped = np.logical_or.reduceat(along > 0, first, axis=0)[group]
    lacks = share(against) * ~helped
    change = np.where(lacks > 0, -lacks, np.minimum(share(along), along))
    of_second = np.ones(len(pair), dtype=bool)
    of_second[np.unique(pair, return_index=True)[1]] = False
    for some in (~of_second, of_second):
        of = pair[some]
        larger = np.abs(change[some]) > np.abs(changes[of])
        changes[of] = np.where(larger, change[some], changes[of])
        forces[of] = np.where(larger, np.abs(force[some]), forces[of])
    return changes, forces


def _drags_of_joints(run: Run, force: Array) -> tuple[Array, Array]:
    """The same of mechanisms with joints that nothing drives, by power, (pairs, steps) [N].

    Drag takes the power delta_q_u' M_u delta_q_u / h^3 of each. The pairs that push it along give
    their force times their speed, and drag has of each the share that it has of all; where none
    pushes, it bears that share of those that it pushes against. `force` is that on beta of each
    contact, shape (steps, n_c, 3) [N].
    """
    changes, forces = np.zeros((2, len(run.slices), run.steps))
    starts = [of.start for _, of in run.slices]
    label = sides(run.simulator)
    moved = run.noted("hinged")
    for i, u in enumerate(hinged(run.system).values()):
        momentum = run.noted("momentum")[:, u - run.system.n_a]
        work = quotient(quotient(np.vecdot(momentum, run["delta_q"][:, u]), run.h), run.h)
        of_body = np.einsum("sckx,ck->scx", moved, label == i)
        given = np.add.reduceat(np.vecdot(force, of_body), starts, axis=1).T  # in the step [J]
        pushes = np.maximum(given, 0.0)
        helps = pushes.any(axis=0)
        bears = np.where(helps, pushes, np.maximum(-given, 0.0))
        share = np.minimum(quotient(work, bears.sum(axis=0)), 1.0)
        strength = np.linalg.norm(force, axis=2)
        way = np.linalg.norm(of_body, axis=2)
        largest = np.maximum.reduceat(np.where(strength > 0, way, 0.0), starts, axis=1).T
        along = quotient(bears, largest)
        change = np.where(helps, share, -share) * along
        larger = np.abs(change) > np.abs(changes)
        changes = np.where(larger, change, changes)
        forces = np.where(larger, along, forces)
    return changes, forces
