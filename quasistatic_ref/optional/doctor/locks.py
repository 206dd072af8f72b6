"""Contacts that cannot rise: sliding, they would have to, and so they lock what they guide."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.did.artifacts import quotient
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import Start, table
from quasistatic_ref.optional.doctor.frame.undecided import LARGE, Undecided
from quasistatic_ref.optional.doctor.texts import amount, finding
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import listed
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.step.standard_form import frame_jacobian
from quasistatic_ref.tolerances import REPEATED

CRAWL: Final = 0.1
"""Speed [m/s, rad/s] up to which contacts that cannot rise may hold a body without a finding: what
is moved slowly enough for the model is slower."""

LOCKED: Final = 0.1
"""Motion in a step over that by Coulomb's law [-] below which a body is locked."""

ROUNDED = 1e-9
"""Share of the largest number of a kind, and for entries of J of 1 [-, m], that is rounding [-]."""


def guided(start: Start) -> Iterator[Finding | Undecided]:
    """Contacts at the start whose gap no joint opens, once for each table and joint."""
    if not start.small:
        yield Undecided("guides", LARGE)
        return
    contacts = start.simulator.plan.geometry.contacts(start.points, start.kinematics)
    J_n, J_1, J_2, J_w = np.abs(np.asarray(frame_jacobian(contacts, contacts.J)))
    J_t = np.hypot(J_1, J_2)
    rounding = ROUNDED * np.maximum(J_t, J_n).max(axis=1, keepdims=True, initial=1.0)
    fixed = (J_n <= rounding).all(axis=1)
    if start.extension is not None:  # a private rise opens the gap
        fixed[start.extension.rises.contacts] = False
    mu_v, _, mu_omega = contacts.mu.T
    slides = (J_t > rounding) & (mu_v > 0)[:, None]
    turns = ~slides.any(axis=1)
    moved = np.where(turns[:, None], (J_w > ROUNDED) & (mu_omega > 0)[:, None], slides)
    clearance = np.where(contacts.phi > REPEATED, contacts.phi, 0.0)
    fastest = quotient(clearance, np.where(turns, mu_omega, mu_v) * start.h)
    under_coulomb = start.simulator.law == COULOMB
    fixed &= moved.any(axis=1) & (fastest < CRAWL) & ~(under_coulomb & (clearance > 0))
    reported: set[tuple[str, str]] = set()
    for j in np.flatnonzero(fixed).tolist():
        joints = [start.system.coordinates[i].joint for i in np.flatnonzero(moved[j])]
        pair = start.pairs[start.pair_of[j]]
        names = listed([*dict.fromkeys(joints)])
        if (names, pair.name) in reported:
            continue
        reported.add((names, pair.name))
        unit = "rad" if turns[j] else "m"
        why = "where Coulomb's law has many solutions, and a run takes the locked one"
        if not under_coulomb:
            why = "and a contact that slides has to rise: it moves by at most "
            why += f"{fastest[j]:.3g} {unit}/s, whatever the force"
        cause = f"{names} cannot open the gap of {pair.name}, {1e3 * clearance[j]:.3g} mm, {why}"
        remedy = _remedy(start, joints[0], names, [table(start, pair)])
        numbers = {"clearance_mm": 1e3 * clearance[j], f"fastest_{unit}_per_s": fastest[j]}
        yield finding("guided-friction", cause, remedy, **numbers)


def _remedy(start: Start, first: str, joints: str, tables: list[str]) -> str:
    """The remedy of a lock: what to change so that the joints can move."""
    names = " or ".join(tables)
    joint = start.system.joint(first)
    of_mjcf = start.system.of_mjcf
    if joint.free:
        return f"give {names} {'condim = 1' if of_mjcf else 'mu_v = 0'}, or more clearance"
    if of_mjcf:
        return f"leave out {names} (contact/exclude), and give {joints} frictionloss"
    instead = "support" if isinstance(joint, Planar) else "joint_friction"
    return f"leave out {names}, and say {instead} in [bodies.{first.partition('/')[0]}]"


def locked(run: Run) -> Iterator[Finding | Undecided]:
    """Free coordinates that contacts hold against more than their friction could, in one step.

    That is the step with most friction. What contacts could bear is their friction coefficients
    times the forces of the same step without friction: there, none presses because it is to rise.
    Coulomb's law, begun from a slip of 0.1 m/s, moves a locked coordinate ten times as far.
    """
    if not run.small:
        yield Undecided("locked guides", LARGE)
        return
    rubbing = np.abs(run["wrench"][:, :, [0, 1, 3]]).sum(axis=(1, 2))
    if not rubbing.any() or run.simulator.law == COULOMB:
        return
    k = int(rubbing.argmax())
    step, _ = run.posed(k)
    contacts = step.contacts
    n_a = step.n_a
    J_n, *J_rubs = frame_jacobian(contacts, contacts.J[:, :, n_a:])
    pressed = run["wrench"][k, :, 2]
    force = np.abs(step.tau_u + pressed @ J_n)  # all but friction
    slow: Callable[..., Any] = part("slow_step")
    frictionless = slow(step.with_fields(cone="frictionless"), run.h)
    smooth = frictionless.wrench[:, 2]
    noise = ROUNDED * np.abs(step.tau_u).max(initial=0.0)

    def could(normal: Array) -> Array:
        """What contacts that press with these forces can bear along each coordinate."""
        sums: Array = np.einsum("icv,ci->v", np.abs(J_rubs), contacts.mu * normal[:, None])
        return sums

    of_system = slice(n_a, run.system.n_v)
    moved = np.abs(run["delta_q"][k, of_system])
    suspect = (force > np.maximum(2 * could(smooth), noise))[: len(moved)]
    suspect &= moved < LOCKED * np.abs(frictionless.delta_q[of_system])
    if not suspect.any():
        return
    try:
        by_coulomb = slow(step, run.h, np.full(contacts.n_c, CRAWL * run.h))
    except QuasistaticError:  # nothing is claimed where Coulomb's law has no solution
        return
    way = np.abs(by_coulomb.delta_q[of_system])
    suspect &= (moved < LOCKED * way) & (way > ROUNDED * way.max(initial=0.0))
    if not suspect.any():
        return
    from scipy.optimize import nnls  # takes as long as a short run

    unsqueezed, _ = nnls(J_n.T, J_n.T @ pressed)  # lever arms press as well
    normal = np.maximum(smooth, unsqueezed)
    bears = could(normal)
    beyond = (force - np.maximum(2 * bears, noise))[: len(way)]
    on = (pressed > 2 * normal)[:, None] & contacts.J[:, :, of_system].any(axis=1)
    reported: set[str] = set()
    for i in sorted(
        np.flatnonzero(suspect & (beyond > 0) & on.any(axis=0)).tolist(), key=lambda i: -beyond[i]
    ):
        coordinate = run.system.coordinates[n_a + i]
        joint = coordinate.joint
        if joint in reported:
            continue
        reported.add(joint)
        j = int(np.where(on[:, i], pressed, 0.0).argmax())
        tables = sorted({table(run, run.pairs[p]) for p in run.pair_of[on[:, i]]})
        unit = "N" if coordinate.unit == "m" else "N m"
        cause = f"{coordinate.name} moves by {amount(moved[i], coordinate.unit)} under "
        cause += f"{force[i]:.3g} {unit} in step {k}, where its contacts could bear "
        cause += f"{bears[i]:.3g} {unit}: {run.simulator.plan.layout.names[j]} presses with "
        cause += f"{pressed[j]:.3g} N, because a contact that slides has to rise and it cannot"
        numbers = {"force": force[i], "could_bear": bears[i], "step": k}
        yield finding("locked-guide", cause, _remedy(run, joint, joint, tables), **numbers)
