"""What the model adds to a step: it is compared with the same step taken slowly.

Targets and loads go on as in the step. At T = 10 s the convex step has no drag, and by Coulomb's
law no boundary layer either: drag = run - convex(T), layer = convex(T) - Coulomb(T).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor.artifacts import quotient
from quasistatic_ref.optional.doctor.bodies import COUNTS
from quasistatic_ref.optional.doctor.slow import Slow
from quasistatic_ref.optional.doctor.start import least
from quasistatic_ref.optional.doctor.stopped import Part, Scene
from quasistatic_ref.optional.doctor.undecided import NO_ANSWER, TOO_MANY, Undecided, failure
from quasistatic_ref.step.standard_form import frame_jacobian

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
    from quasistatic_ref.optional.doctor.run import Run
    from quasistatic_ref.step.contacts import Contacts

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
    stays = np.flatnonzero(before & now).tolist()
    try:
        parts = [*Scene(run, k, run["q"][k], run["phi"][k], run.points_of(k)).parts()]
    except QuasistaticError as error:
        yield from (Undecided(run.pairs[i].name, failure(error)) for i in stays)
        return
    for part in parts:
        pairs = np.intersect1d(stays, run.pair_of[part.contacts]).tolist()
        why = TOO_MANY if part.large else ""
        try:
            if pairs and not why:
                yield from _changes(run, k, part, pairs)
        except QuasistaticError as error:
            why = failure(error)
        yield from (Undecided(run.pairs[i].name, why) for i in pairs if why)


def _changes(run: Run, k: int, part: Part, pairs: list[int]) -> Iterator[Change | Undecided]:
    """The changes of some pairs of a group; QuasistaticError if something in the group falls."""
    at = part.contacts
    before = run.touches[max(k - 1, 0)]
    slow = _landed(part.slow, (run.touches[k] & before & (k > 0))[at])
    rungs = [slow.last] if slow.last else slow.climbed
    last = rungs[-1] if rungs else None
    if last and np.abs(last.delta_q[slow.step.n_a :]).max(initial=0.0) > FALLS * last.T**2:
        return
    if last is None or slow.end > last.T:
        yield from (Undecided(run.pairs[i].name, NO_ANSWER) for i in pairs)
        return
    contacts = slow.step.contacts
    delta_q, forces = slow.convex(slow.end, slow.level)
    motion = contacts.motion(last.delta_q)
    laws = (
        (run.at(k).forces[at], run.noted("moved")[k, at]),
        (forces, contacts.motion(delta_q)),
        (last.forces, motion),
    )
    inner = inner_loads(contacts, last.forces, motion)
    for i in pairs:
        of = run.pair_of[at] == i
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
        stays = slowly[0] > COUNTS * here[0]
        counts = np.concatenate([known, ways & sticks & rubs & stays])
        sizes = np.array([force, force, arm, *here[SLIP:]])
        drag = here - convex
        layer = convex - slowly
        change = np.minimum(np.abs(here - slowly), np.maximum(np.abs(drag), np.abs(layer)))
        shares = counts * quotient(change, sizes)
        j = int((shares >= (1 - EQUAL) * shares.max()).argmax())  # the force, where it is as much
        amounts = (float(x[j]) for x in (here, slowly, drag, layer))
        yield Change(float(shares[j]), k, i, j, *amounts)


def _landed(slow: Slow, touches: Mask) -> Slow:
    """The slow step after its bodies have come down from their layers.

    Springs follow, and nothing rubs on the way: by Coulomb's law none rose. Else what comes down
    along something that it sticks to would be held by it.
    """
    step = slow.step
    phi = step.contacts.phi[touches]
    if not phi.any():
        return slow
    J_n = frame_jacobian(step.contacts, step.contacts.J)[0]
    root = np.linalg.inv(np.linalg.cholesky(step.H)).T
    down = root @ np.linalg.lstsq(J_n[touches] @ root, -phi, rcond=NULL)[0]
    landed = step.replace(
        contacts=step.contacts.raised(J_n @ down),
        delta_q_bar_a=step.delta_q_bar_a - down[: step.n_a],
        extra=step.extra.with_fields(b=step.extra.b - step.extra.A @ down),
    )
    return Slow(landed, slow.sizes, slow.turns)


def _acts(run: Run, axes: tuple[Array, Array], forces: Array, motion: Array, at: Indices) -> Array:
    """Normal force, friction, torque, and the longest slip and spin of what presses, shape (5,)."""
    presses = forces[:, 2] > INNER * forces[:, 2].max(initial=0.0)
    slips = np.hypot(*(np.vecdot(motion[:, :3], d) for d in axes))
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


def inner_loads(contacts: Contacts, forces: Array, motion: Array) -> Array:
    """Forces z with J'z = 0, of contacts with load; what slips keeps its ray (n, -mu slip).

    Parameters
    ----------
    contacts : Contacts
    forces, motion : ndarray, shape (n_c, 4)
        Along d1, d2 and n, and about n [N, N m]; J delta_q [m, rad].

    Returns
    -------
    ndarray, shape (n_c, 4, dimensions)
    """
    f_n = forces[:, 2]
    loaded = np.flatnonzero(f_n > NULL * f_n.max(initial=0.0))
    J_n, J_1, J_2, J_w = frame_jacobian(contacts, contacts.J)
    frames = np.stack([J_1, J_2, J_n, J_w], axis=1)[loaded]  # as forces are
    rubs = contacts.mu[loaded] > 0
    d1, d2 = (np.vecdot(motion[:, :3], d)[loaded] for d in (contacts.d1, contacts.d2))
    slips = (np.hypot(d1, d2) > NULL) | (rubs[:, 2] & (np.abs(motion[loaded, 3]) > NULL))
    rays = np.eye(4) * np.insert(rubs, 2, True, axis=1)[:, None]  # in columns; some are nothing
    rays[slips] = 0.0
    rays[slips, :, 2] = (forces[loaded] / f_n[loaded, None])[slips]
    rows = np.einsum("jci,jcv->jiv", rays, frames).reshape(4 * len(loaded), contacts.n_v)
    rows = rows / np.maximum(np.abs(rows).max(axis=0, initial=0.0), 1e-300)
    _, sizes, vt = np.linalg.svd(rows.T)
    null = vt[int((sizes > NULL * sizes.max(initial=0.0)).sum()) :].T
    inner = np.zeros((*forces.shape, null.shape[1]))
    inner[loaded] = np.einsum("jci,jid->jcd", rays, null.reshape(len(loaded), 4, null.shape[1]))
    return inner
