"""Contacts that cannot rise: sliding, they would have to, and so they lock what they guide."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import Start, table
from quasistatic_ref.optional.doctor.telling import amount
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.step.standard_form import frame_jacobian
from quasistatic_ref.text.quoting import listed
from quasistatic_ref.tolerances import REPEATED

CRAWL: Final = 0.1
"""Speed [m/s, rad/s] up to which contacts that cannot rise may hold a body without a finding: what
is moved slowly enough for the model is slower."""

LOCKED: Final = 0.1
"""Motion in a step over that by Coulomb's law [-] below which a body is locked."""

TINY = 1e-9
"""Entries of J, relative to the contact's largest or to 1 [-, m], that are rounding."""


def guided(start: Start) -> Iterator[Finding]:
    """Contacts at the start whose gap no joint opens, once for each table and joint."""
    if start.points is None:
        return
    contacts = start.contacts_at_start
    J_n, J_1, J_2, J_w = np.abs(np.asarray(frame_jacobian(contacts, contacts.J)))
    J_t = np.hypot(J_1, J_2)
    rounding = TINY * np.maximum(J_t, J_n).max(axis=1, keepdims=True, initial=1.0)
    fixed = (J_n <= rounding).all(axis=1)
    fixed[start.raised] = False
    clearance = np.where(contacts.phi > REPEATED, contacts.phi, 0.0)
    mu_v, _, mu_omega = contacts.mu.T
    reported: set[tuple[str, str]] = set()
    for j in np.flatnonzero(fixed).tolist():
        slides = J_t[j] > rounding[j]
        turns = not (mu_v[j] > 0 and slides.any())
        moved = J_w[j] > TINY if turns else slides
        mu = mu_omega[j] if turns else mu_v[j]
        if not (mu > 0 and moved.any()):
            continue
        fastest = float(clearance[j] / (mu * start.h))
        of_moved = [start.system.coordinates[i].joint for i in np.flatnonzero(moved)]
        joints = listed([*dict.fromkeys(of_moved)])
        joint = start.system.joint(of_moved[0])
        pair = start.pairs[start.pair_of[j]]
        under_coulomb = start.simulator.law == COULOMB
        key = (pair.name, joints)
        if fastest >= CRAWL or key in reported or (under_coulomb and clearance[j]):
            continue
        reported.add(key)
        unit = "rad" if turns else "m"
        gap = f"{joints} cannot open the gap of {pair.name}, {1e3 * clearance[j]:.3g} mm, "
        why = "where Coulomb's law has many solutions, and a run takes the locked one"
        if not under_coulomb:
            why = f"and a contact that slides has to rise: it moves by at most {fastest:.3g} "
            why += f"{unit}/s, whatever the force"
        numbers = {"clearance_mm": 1e3 * float(clearance[j]), f"fastest_{unit}_per_s": fastest}
        remedy = _remedy(start, joint, joints, [table(start, pair)])
        yield Finding("guided-friction", True, remedy, gap + why, numbers)


def _remedy(start: Start, joint: Joint, joints: str, tables: list[str]) -> str:
    names = " or ".join(tables)
    of_mjcf = start.system.of_mjcf
    if joint.free:
        return f"give {names} {'condim = 1' if of_mjcf else 'mu_v = 0'}, or more clearance"
    if of_mjcf:
        return f"leave out {names} (contact/exclude), and give {joints} frictionloss"
    instead = "support" if isinstance(joint, Planar) else "joint_friction"
    return f"leave out {names}, and say {instead} in [bodies.{joint.name.partition('/')[0]}]"


def locked(run: Run) -> Iterator[Finding]:
    """Free coordinates that contacts hold against more than their friction could, in one step.

    That is the step with most friction. What contacts could bear is their friction coefficients
    times the forces of the same step without friction: there, none presses because it is to rise.
    Coulomb's law, begun from a slip of 0.1 m/s, moves a locked coordinate ten times as far.
    """
    rubbing = np.abs(run["wrench"][:, :, [0, 1, 3]]).sum(axis=(1, 2))
    if not rubbing.any() or run.simulator.law == COULOMB:
        return
    k = int(rubbing.argmax())
    step = run.at(k).posed
    contacts = step.contacts
    n_a = step.n_a
    J_n, *J_rubs = frame_jacobian(contacts, contacts.J[:, :, n_a:])
    wrench = run["wrench"][k]
    force = step.tau_u + wrench[:, 2] @ J_n  # all but friction
    slow: Callable[..., Any] = part("slow_step")
    smooth = slow(step.with_fields(cone="frictionless"), run.h)
    noise = TINY * np.abs(step.tau_u).max(initial=0.0)

    def friction(normal: Array) -> Array:
        """What contacts that press with these forces can bear along each coordinate."""
        sums: Array = np.einsum("icv,ci->v", np.abs(J_rubs), contacts.mu * normal[:, None])
        return sums

    if not (np.abs(force) > np.maximum(2 * friction(smooth.wrench[:, 2]), noise)).any():
        return
    from scipy.optimize import nnls  # takes as long as a short run

    unsqueezed, _ = nnls(J_n.T, J_n.T @ wrench[:, 2])  # lever arms press as well
    normal = np.maximum(smooth.wrench[:, 2], unsqueezed)
    could = friction(normal)
    suspect = np.abs(force) > np.maximum(2 * could, noise)
    if not suspect.any():
        return
    begin = np.full(contacts.n_c, CRAWL * run.h)
    try:
        by_coulomb = slow(step, run.h, begin)
    except QuasistaticError:  # nothing is claimed where Coulomb's law has no solution
        return
    moved = np.abs(run["delta_q"][k, n_a:])
    of_system = slice(n_a, run.system.n_v)
    way = np.abs(by_coulomb.delta_q[of_system])
    suspect = suspect[: len(way)] & (moved < LOCKED * way) & (way > TINY * way.max(initial=0.0))
    reported: set[str] = set()
    beyond = np.abs(force) - could
    for i in sorted(np.flatnonzero(suspect).tolist(), key=lambda i: -beyond[i]):
        coordinate = run.system.coordinates[n_a + i]
        on = (wrench[:, 2] > 2 * normal) & contacts.J[:, :, n_a + i].any(axis=1)
        if coordinate.joint in reported or not on.any():
            continue
        reported.add(coordinate.joint)
        j = int(np.where(on, wrench[:, 2], 0.0).argmax())
        tables = sorted({table(run, run.pairs[p]) for p in run.pair_of[on]})
        unit = "N" if coordinate.unit == "m" else "N m"
        cause = f"{coordinate.name} moves by {amount(float(moved[i]), coordinate.unit)} under "
        cause += f"{abs(force[i]):.3g} {unit} in step {k}, where its contacts could bear "
        cause += f"{could[i]:.3g} {unit}: {run.simulator.layout.names[j]} presses with "
        cause += f"{wrench[j, 2]:.3g} N, because a contact that slides has to rise and it cannot"
        numbers = {"force": float(abs(force[i])), "could_bear": float(could[i]), "step": k}
        name = coordinate.joint
        remedy = _remedy(run, run.system.joint(name), name, tables)
        yield Finding("locked-guide", True, remedy, cause, numbers)
