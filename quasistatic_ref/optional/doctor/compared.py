"""What the model adds to a step: it is compared with the same step taken slowly.

Targets and loads go on as in the step. At T = 10 s the convex step has no drag, and by Coulomb's
law no boundary layer either: drag = run - convex(T), layer = convex(T) - Coulomb(T).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor.artifacts import quotient
from quasistatic_ref.optional.doctor.bodies import COUNTS
from quasistatic_ref.optional.doctor.scenes import Scene
from quasistatic_ref.optional.doctor.start import least
from quasistatic_ref.optional.doctor.undecided import NO_ANSWER, TOO_MANY, Undecided, failure

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.optional.doctor.programs import Alike
    from quasistatic_ref.optional.doctor.run import Run
    from quasistatic_ref.optional.doctor.slow import Slow

SLID = 0.01
"""Slip over the smaller shape, or spin [rad], of a pair in a run, from which it counts [-]."""
FALLS = 0.01
"""Acceleration in a slow step with which something falls [m/s^2, rad/s^2]."""
NULL = 1e-9
"""Singular value that is none, over the largest; slip that is none [m, rad]."""
INNER = 1e-6
"""Part of an inner load, of length 1, that is none in the resultants of a pair [-]."""
EQUAL = 1e-6
"""Difference of two shares of a change that is none: a force and its torque have equal ones."""
TORQUE = 2
SLIP = 3
SPIN = 4
"""Their numbers among normal force, friction, torque, slip and spin."""


class Change(NamedTuple):
    """What a pair does in a step of the run, and slowly.

    Parameters
    ----------
    share : float
        How much of it changes, and by drag or the layer alone [-].
    k, pair : int
    what : int
        Normal force, friction, torque, slip or spin.
    here, slowly, drag, layer : float
        here = slowly + drag + layer [N, N, N m, m, rad].
    """

    share: float
    k: int
    pair: int
    what: int
    here: float
    slowly: float
    drag: float
    layer: float

    @property
    def rank(self) -> tuple[float, float]:
        """Sort key of a change: its share, then its amount."""
        return round(self.share, 2), max(abs(self.drag), abs(self.layer))


def compared(run: Run, k: int) -> Iterator[Change | Undecided]:
    """For each pair that presses in step k, the largest change that the model makes."""
    slots = run.pair_of == np.arange(len(run.pairs))[:, None]
    before, now = ((slots & on).any(axis=1) for on in run.touches[[max(k - 1, 0), k]])
    stays = before & now
    try:
        scene = Scene(run, k, run["q"][k], run["phi"][k], run.points_of(k))
    except QuasistaticError as error:
        names = (run.pairs[i].name for i in np.flatnonzero(stays))
        yield from (Undecided(name, failure(error)) for name in names)
        return
    for slow in scene.parts:
        contacts = slow.groups.contacts
        of = np.flatnonzero(stays[run.pair_of[contacts]].any(axis=1))
        if slow.large:
            yield from _undecided(run, stays, contacts[of], TOO_MANY)
        elif of.size:
            on = run.touches[k, contacts] & run.touches[max(k - 1, 0), contacts] & (k > 0)
            yield from _changes(run, k, slow.landed(run.h, on), of, stays)


def _undecided(run: Run, stays: Mask, contacts: Indices, why: str) -> Iterator[Undecided]:
    """The pairs of some contacts that stay, which are not compared."""
    for i in np.unique(run.pair_of[contacts]).tolist():
        if stays[i]:
            yield Undecided(run.pairs[i].name, why)


def _changes(
    run: Run, k: int, slow: Slow, of: Indices, stays: Mask
) -> Iterator[Change | Undecided]:
    """The changes of pairs that stay in some groups, unless something in their group falls."""
    last = slow.slowly(of)
    motion = np.abs(last.delta_q[:, slow.groups.n_a :]).max(axis=1, initial=0.0)
    stands = ~last.found | (motion <= FALLS * slow.T**2)
    delta_q, forces, solved = slow.convex(of)
    known = last.found & solved
    yield from _undecided(run, stays, slow.groups.contacts[of[stands & ~known]], NO_ANSWER)
    for j in np.flatnonzero(stands & known).tolist():
        group = slow.groups.some(of[j : j + 1])
        laws = [
            (x[j], group.motion(q[j : j + 1])[0])
            for x, q in ((forces, delta_q), (last.forces, last.delta_q))
        ]
        yield from _of_group(run, k, group, laws, stays)


def _of_group(
    run: Run, k: int, group: Alike, laws: Sequence[tuple[Array, Array]], stays: Mask
) -> Iterator[Change]:
    """The changes of the pairs of a group that stay.

    Parameters
    ----------
    laws : sequence of (ndarray, ndarray)
        Forces and J delta_q of its contacts, (n_c, 4) each [N, N m] and [m, rad], along d1, d2 and
        n, and about n: by the convex step, slowly, and by Coulomb's law.
    """
    at = group.contacts[0]
    moved = run.noted("moved")[k, at]
    along = [np.vecdot(moved[:, :3], run[axis][k, at]) for axis in ("d1", "d2", "n")]
    laws = [(run.at(k).forces[at], np.stack([*along, moved[:, 3]], axis=1)), *laws]
    inner = inner_loads(group.frames[0], group.mu[0], *laws[2])
    for i in np.unique(run.pair_of[at]).tolist():
        of = run.pair_of[at] == i
        if not stays[i]:
            continue
        axes = run.axes(k, at[of])
        here, convex, slowly = (_acts(run, axes, f[of], m[of], at[of]) for f, m in laws)
        force = max(*here[:TORQUE], *slowly[:TORQUE], run.largest(run.pair_of == i))
        pair = run.pairs[i]
        arm = pair.mu_omega * force if pair.rows == 6 else 0.0
        known = (_sizes(resultants(axes, inner[of])) <= INNER).all(axis=1)
        ways = run.ways(i) > SLID * np.array([least(pair), 1.0])
        slips = here[SLIP:] > NULL
        sticks = slips & (slowly[SLIP:] < COUNTS * here[SLIP:])
        rubs = [pair.mu_v > 0, arm > 0]
        presses = slowly[0] > COUNTS * here[0]
        counts = np.concatenate([known, ways & sticks & rubs & presses])
        sizes = np.array([force, force, arm, *here[SLIP:]])
        drag = here - convex
        layer = convex - slowly
        change = np.minimum(np.abs(here - slowly), np.maximum(np.abs(drag), np.abs(layer)))
        shares = counts * quotient(change, sizes)
        j = int((shares >= (1 - EQUAL) * shares.max()).argmax())  # the force, where it is as much
        amounts = (float(x[j]) for x in (here, slowly, drag, layer))
        yield Change(float(shares[j]), k, i, j, *amounts)


def _acts(run: Run, axes: tuple[Array, Array], forces: Array, motion: Array, at: Indices) -> Array:
    """Normal force, friction, torque, and the longest slip and spin of what presses, shape (5,)."""
    presses = forces[:, 2] > INNER * forces[:, 2].max(initial=0.0)
    slips = np.hypot(motion[:, 0], motion[:, 1])
    spins = np.where(run["rows"][at] == 6, np.abs(motion[:, 3]), 0.0)
    moves = np.stack([slips, spins])[:, presses].max(axis=1, initial=0.0)
    return np.concatenate([_sizes(resultants(axes, forces)), moves])


def _sizes(resultants: Array) -> Array:
    """Normal force, friction and torque of resultants, shape (5, ...), shape (3, ...)."""
    normal, *rubs, torque = resultants
    return np.stack([np.abs(normal), np.linalg.norm(rubs, axis=0), np.abs(torque)])


def resultants(axes: tuple[Array, Array], forces: Array) -> Array:
    """Sums of forces, (n_c, 4, ...): the normal one, friction along the axes, and torque, (5, ...).

    The axes are d1 and d2, each (n_c, 3) [-]. Units are those of the forces [N, N, N, N, N m].
    """
    f_1, f_2, f_n, torque = np.moveaxis(forces, 1, 0)
    rubs = axes[0].T @ f_1 + axes[1].T @ f_2
    return np.concatenate([[f_n.sum(axis=0)], rubs, [torque.sum(axis=0)]])


def inner_loads(frames: Array, mu: Array, forces: Array, motion: Array) -> Array:
    """Forces z with J'z = 0, of contacts with load; what slips keeps its ray (n, -mu slip).

    All are along d1, d2 and n, and about n.

    Parameters
    ----------
    frames : ndarray, shape (n_c, 4, n)
        J [m, rad].
    mu : ndarray, shape (n_c, 3)
        (mu_v, mu_v, mu_omega) [-, -, m].
    forces, motion : ndarray, shape (n_c, 4)
        [N, N m], and J delta_q [m, rad].

    Returns
    -------
    ndarray, shape (n_c, 4, dimensions)
    """
    f_n = forces[:, 2]
    loaded = np.flatnonzero(f_n > NULL * f_n.max(initial=0.0))
    frames = frames[loaded]
    rubs = mu[loaded] > 0
    d1, d2, _, spin = np.abs(motion[loaded]).T
    slips = (np.hypot(d1, d2) > NULL) | (rubs[:, 2] & (spin > NULL))
    rays = np.eye(4) * np.insert(rubs, 2, True, axis=1)[:, None]  # in columns; some are nothing
    rays[slips] = 0.0
    rays[slips, :, 2] = (forces[loaded] / f_n[loaded, None])[slips]
    rows = np.einsum("jci,jcv->jiv", rays, frames).reshape(4 * len(loaded), frames.shape[2])
    rows = rows / np.maximum(np.abs(rows).max(axis=0, initial=0.0), 1e-300)
    _, sizes, vt = np.linalg.svd(rows.T)
    null = vt[int((sizes > NULL * sizes.max(initial=0.0)).sum()) :].T
    inner = np.zeros((*forces.shape, null.shape[1]))
    inner[loaded] = np.einsum("jci,jid->jcd", rays, null.reshape(len(loaded), 4, null.shape[1]))
    return inner
