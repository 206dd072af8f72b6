"""What drag and the boundary layer add to the forces of pairs, read from the record of a run.

Drag M v / h of a free body is borne by the pairs that push along it, by their shares, and is
missing in those that it pushes against. A spring presses by the layer s over what it gives.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.did.artifacts import LIGHT, drag, quotient
from quasistatic_ref.optional.doctor.frame.run import Run, in_world
from quasistatic_ref.optional.doctor.frame.start import SHORT
from quasistatic_ref.optional.doctor.texts import finding
from quasistatic_ref.optional.friction import slip_norm
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
    every = normal + f[..., :1] * run["d1"] + f[..., 1:2] * run["d2"]
    starts = [of.start for _, of in run.slices]
    every, pushed = (np.add.reduceat(x, starts, axis=1).swapaxes(0, 1) for x in (every, normal))
    by_drag, along = _drags(run, every, pushed)
    layer = layers(run)
    for name, base in run.free_bases.items():
        layer[np.ix_(run.falls(base), run.of_body(name))] = 0.0
    moves = run.targets_move | run.loads_move
    for i, (_, of) in enumerate(run.slices):
        on: Mask = np.asarray(run.touches[:, of].any(axis=1), dtype=np.bool_)
        stays = on & np.append(run.steps == 1, on[:-1]) & moves
        pressed = np.linalg.norm(pushed[i], axis=1)
        lands = run["phi"][:, of].max(axis=1) > SHORT * run.sizes[of.start]
        by_drag[i, lands] = np.maximum(by_drag[i, lands], 0.0)
        by_layer = np.minimum(layer[:, of].max(axis=1), pressed)
        parts = np.array([by_drag[i], by_layer]) * stays
        here = np.where(np.abs(parts[0]) >= parts[1], along[i], pressed)
        largest = f[min(1, run.steps - 1) :, of, 2].sum(axis=1).max()
        whole = max(largest, float(np.maximum(here, here - parts[0]).max()))
        shares = quotient(np.abs(parts).max(axis=0), whole)
        k = int(np.flatnonzero(shares >= NEARLY * shares.max())[-1])
        yield Added(float(shares[k]), k, i, float(here[k]), *map(float, parts[:, k]))


def layers(run: Run) -> Array:
    """Force that the boundary layer may add at each contact, shape (steps, n_c) [N]."""
    s = np.where(run.touches, slip_norm(run.mu * run.slips, run.simulator.cone), 0.0)
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
    for name, base in run.free_bases.items():
        which = np.unique(run.pair_of[run.of_body(name)])
        link = run.system.link(name)
        pairs = [run.pairs[i] for i in which]
        signs = [float(p.beta.link == link) - float(p.alpha.link == link) for p in pairs]
        F = in_world(run["q"][:-1, base.q][:, 3:], drag(run, base))
        size = np.linalg.norm(F, axis=1)
        force, pressed = (
            np.array(signs)[:, None] * quotient(np.einsum("pkx,kx->pk", f[which], F), size)
            for f in (every, normal)
        )
        along = np.maximum(force, 0.0)
        faces = pressed < FACES * np.linalg.norm(normal[which], axis=2)
        against = np.where(faces, -pressed, 0.0)
        adds = np.minimum(size * quotient(along, along.sum(axis=0)), along)
        lacks = size * quotient(against, against.sum(axis=0)) * ~along.any(axis=0)
        change = np.where(lacks > 0, -lacks, adds)
        larger = np.abs(change) > np.abs(changes[which])
        changes[which] = np.where(larger, change, changes[which])
        forces[which] = np.where(larger, np.abs(force), forces[which])
    return changes, forces
