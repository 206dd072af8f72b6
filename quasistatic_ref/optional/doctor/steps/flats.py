"""Flat faces that are pressed together, and bear on a point or an edge that rounding chooses."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import SHORT
from quasistatic_ref.optional.doctor.frame.undecided import LARGE, Undecided
from quasistatic_ref.optional.doctor.texts import finding
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import ContactForces

LIGHT: Final = "light"
"""The record that holds no forces."""
FLAT: Final = 1e-6
"""Gap up to which faces are flat on each other [m]: pads of robots give more."""
CLOSED: Final = 1e-13
"""Gap that counts as closed [m]: rounding leaves less, and the compliance of forces closes more."""
PARALLEL: Final = 1e-6
"""1 - cosine of the angle between normals of one face, at most [-]."""
NARROW: Final = 0.1
"""Width of what bears over that of a face [-], of a point or an edge."""
BEARS: Final = 1e-3
"""Share of a pair's largest normal force [-] from which on a contact bears."""
COUNTS: Final = 0.1
"""Change of a pair's friction over its normal force [-] from which on it is said."""


def flat_contact(run: Run) -> Iterator[Finding | Undecided]:
    """The pair of something driven whose friction most depends on the gaps of flat faces.

    It is asked of the step in which such faces press most. A light record has no forces to read.
    """
    if run.trajectory.header.record == LIGHT:
        return
    chosen = {i: _chosen(run, of) for i, (pair, of) in enumerate(run.slices) if _driven(run, pair)}
    pressed = {
        i: run["wrench"][:, run.slices[i][1], 2].sum(axis=1) * on for i, on in chosen.items()
    }
    most = max(pressed, key=lambda i: float(pressed[i].max()), default=None)
    if most is None or not pressed[most].any():
        return
    if not run.small:
        yield Undecided("points of flat faces", LARGE)
        return
    k = int(pressed[most].argmax())
    step, is_all = _step(run, k)
    if is_all:
        rigid = run.trajectory.step_forces(k)
        changes = [Change.of(run, k, i, step, rigid) for i in chosen if chosen[i][k]]
        largest = max(changes, key=lambda change: change.share)
        if largest.share > COUNTS:
            yield _told(run, k, largest)


def _driven(run: Run, pair: ContactPair) -> bool:
    return bool(run.driven[pair.alpha.link] or run.driven[pair.beta.link])


def _step(run: Run, k: int) -> tuple[StepData, bool]:
    """Step k as it was solved, with gaps that Coulomb's law has raised, and if that is all."""
    step, is_all = run.posed(k)
    if "s" in run.arrays:
        raised = step.contacts.phi + run["s"][k]
        step = step.with_fields(contacts=step.contacts.with_fields(phi=raised))
    return step, is_all


def _flat(run: Run, of: slice) -> tuple[Mask, Array]:
    """Which contacts of a pair are on flat faces, (steps, n), and their slack after a step [m]."""
    slack = run.gap[:, of]
    if run.simulator.law == CONVEX:  # which raises what slips
        slack = slack - slip_norm(run.mu[of] * run.slips[:, of], run.simulator.cone)
    n = run["n"][:, of]
    nearest = np.take_along_axis(n, slack.argmin(axis=1)[:, None, None], axis=1)
    parallel = (n * nearest).sum(axis=2) > 1 - PARALLEL
    return parallel & (slack <= FLAT), slack


def _chosen(run: Run, of: slice) -> Mask:
    """The steps in which what is closed of a pair's flat faces is a point or an edge, (steps,)."""
    flat, slack = _flat(run, of)
    closed = flat & (slack <= CLOSED)
    face = _width(run["beta"][:, of], flat)
    bears = _width(run["beta"][:, of], closed)
    narrow = closed.any(axis=1) & (bears < NARROW * face)
    return np.asarray(narrow & (face > SHORT * run.sizes[of.start]))


def _width(points: Array, which: Mask) -> Array:
    """The smaller spread of some points of faces, (steps, n, 3) [m], in each step, (steps,) [m]."""
    weights = which / np.maximum(which.sum(axis=1, keepdims=True), 1)
    off = points - np.einsum("kn,knx->kx", weights, points)[:, None]
    moments = np.einsum("kn,knx,kny->kxy", weights, off, off)
    return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(moments)[:, 1], 0.0)))


class Change(NamedTuple):
    """What becomes of a pair's friction in a step if its faces give.

    Parameters
    ----------
    share : float
        Change of the friction over the normal force [-].
    pair, points, bearing : int
        Its number; its points on flat faces, and those of them that bear.
    friction, soft : float
        Its friction, and where faces give [N].
    gap : float
        The largest of those points [m].
    compliance : float
        Of each contact [m/N].
    """

    share: float
    pair: int
    points: int
    bearing: int
    friction: float
    soft: float
    gap: float
    compliance: float

    @classmethod
    def of(cls, run: Run, k: int, i: int, step: StepData, forces: Array) -> Change:
        """That of pair i in step k, whose contacts have these forces, (n_c, 4) [N, N m]."""
        _, of = run.slices[i]
        flat, slack = _flat(run, of)
        normal = forces[of, 2]
        compliance = float(f"{FLAT * flat[k].sum() / normal.sum():.1g}")  # as it is said
        contact_forces: Callable[[StepData, float], ContactForces] = part("contact_forces")
        soft = contact_forces(step, compliance).wrench
        frictions = [np.linalg.norm(_friction(run, k, of, f)) for f in (forces, soft)]
        change = np.linalg.norm(_friction(run, k, of, forces - soft))
        return cls(
            share=float(change / normal.sum()),
            pair=i,
            points=int(flat[k].sum()),
            bearing=int((normal > BEARS * normal.max()).sum()),
            friction=float(frictions[0]),
            soft=float(frictions[1]),
            gap=float(slack[k, flat[k]].max()),
            compliance=compliance,
        )


def _friction(run: Run, k: int, of: slice, forces: Array) -> Array:
    """The sum of a pair's friction by the forces of all contacts, (n_c, 4) [N, N m]: (3,) [N]."""
    d1, d2 = run["d1"][k, of], run["d2"][k, of]
    return np.asarray(forces[of, 0] @ d1 + forces[of, 1] @ d2)


def _told(run: Run, k: int, change: Change) -> Finding:
    """The finding on a pair in step k."""
    pair = run.pairs[change.pair]
    points = f"{change.bearing} of {change.points} points of flat faces"
    cause = f"{pair.name} bears on {points}, which gaps below {change.gap:.1g} m choose, with "
    cause += f"{change.friction:.3g} N of friction; if the faces gave {1e6 * FLAT:g} um, it would "
    cause += f"be {change.soft:.3g} N (step {k})"
    held, _ = run.held_by(change.pair)
    remedy = f'turn the faces parallel, or read the sum of all pairs, run.forces_on("{held}"), or '
    remedy += f"soft faces, qr.contact_forces(run.step_data({k}), {change.compliance:g})"
    numbers = {"friction_N": change.friction, "soft_N": change.soft, "step": k}
    numbers |= {"points": change.points, "bearing": change.bearing}
    return finding("flat-contact", cause, remedy, pair.name.partition("(")[0], **numbers)
