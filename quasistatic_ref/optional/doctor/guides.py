"""Contacts that cannot rise: sliding, they would have to."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.optional.doctor.artifacts import pressing
from quasistatic_ref.optional.doctor.equilibrium import at_rest, borne, unsqueezed
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import Start, table
from quasistatic_ref.optional.doctor.telling import amount
from quasistatic_ref.optional.doctor.undecided import optimum
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import frame_jacobian
from quasistatic_ref.tolerances import REPEATED, SAME_NORMAL

CRAWL: Final = 0.1
"""Speed [m/s, rad/s] up to which contacts that cannot rise may hold a body without a finding: what
is moved slowly enough for the model is slower."""

LOCKED: Final = 0.1
"""Share of the motion without a guide's own friction [-] below which a body is locked by it. A
block that begins to slide has 1 / (1 + mu_v^2) of it, one in a guide the guide's clearance."""

TINY = 1e-9
"""Entries of J, relative to the contact's largest or to 1 [-, m], that are rounding."""
INFEASIBLE = 2
"""SciPy's status of a linear program that has no solution."""
SIDES = 9
"""Decimals to which normals are those of one side."""


class Guide(NamedTuple):
    """A contact, or contacts that face each other, which let a body slide by little.

    Parameters
    ----------
    contacts : tuple of int
    moved : ndarray of bool, shape (n_v,)
        The coordinates that slide it.
    clearance : float
        How far the contacts may rise, together [m].
    mu : float
        mu_v [-], or mu_omega [m] where it only turns; of all together.
    turns : bool
    """

    contacts: tuple[int, ...]
    moved: Array
    clearance: float
    mu: float
    turns: bool


def guides(start: Start, contacts: Contacts) -> Iterator[Guide]:
    """Contacts whose gap no coordinate opens, and contacts of a body between what stands.

    Between are contacts on two or three sides, whose normals are such that sum w n = 0 with w > 0,
    and sum w n'J = 0, lever arms included, so that no turn opens them: for a slip x along all of
    them sum w (phi - mu |x|) >= 0.
    """
    signed = np.asarray(frame_jacobian(contacts, contacts.J))
    J_n, J_1, J_2, J_w = np.abs(signed)
    J_t = np.hypot(J_1, J_2)
    rounding = TINY * np.maximum(J_t, J_n).max(axis=1, keepdims=True, initial=1.0)
    slides = J_t > rounding
    turns = J_w > TINY
    clearance = np.where(contacts.phi > REPEATED, contacts.phi, 0.0)
    fixed = (J_n <= rounding).all(axis=1)
    fixed[start.raised] = False
    mu_v = contacts.mu[:, 0]
    mu_omega = contacts.mu[:, 2]
    for j in np.flatnonzero(fixed).tolist():
        if mu_v[j] > 0 and slides[j].any():
            yield Guide((j,), slides[j], float(clearance[j]), float(mu_v[j]), False)
        elif mu_omega[j] > 0 and turns[j].any():
            yield Guide((j,), turns[j], float(clearance[j]), float(mu_omega[j]), True)
    # Of what stands nothing moves: all of J is the other body's.
    layout = start.simulator.layout
    moves = np.any(start.system.column_map.moves, axis=(1, 2))
    links = np.column_stack([layout.link_alpha, layout.link_beta])
    standing = ~moves[links]
    near = (standing.sum(axis=1) == 1) & (mu_v > 0) & (clearance < CRAWL * start.h * 2 * mu_v)
    body = np.where(standing[:, 0], links[:, 1], links[:, 0])
    n = np.where(standing[:, :1], contacts.n, -contacts.n)
    for link in np.unique(body[near & ~fixed]).tolist():
        for sides, w in _between(n, np.flatnonzero(near & ~fixed & (body == link))):
            of_guide = np.concatenate(sides)
            reach = np.hypot(J_t, J_n)[of_guide].max(axis=0)  # of each coordinate
            share = _squeeze(
                signed[0, of_guide] / np.where(reach > 0, reach, 1.0), sides, w, clearance[of_guide]
            )
            moved = slides[of_guide].any(axis=0)
            if share is None or not moved.any():
                continue
            together = float(share @ clearance[of_guide]), float(share @ mu_v[of_guide])
            yield Guide(tuple(of_guide.tolist()), moved, *together, False)


def _between(n: Array, contacts: Indices) -> Iterator[tuple[tuple[Indices, ...], Array]]:
    """Two or three sides, each with the numbers of its contacts, with w > 0 and sum w n = 0.

    n, shape (n_c, 3), holds the normals, and w, shape (2,) or (3,) [-], is 1 at most.
    """
    rounded = n[contacts].round(SIDES)
    if (rounded == rounded[0]).all():
        return
    _, first, side = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    for count in (2, 3):
        choices = np.reshape([*combinations(range(len(first)), count)], (-1, count)).astype(int)
        normals = n[contacts[first[choices]]]
        least = np.linalg.svd(normals.swapaxes(1, 2))[2][:, -1]  # of all |w| = 1, |sum w n|
        weights = least * np.sign(least[:, :1])
        left = np.abs(np.einsum("is,isx->ix", weights, normals)).max(axis=1, initial=0.0)
        for i in np.flatnonzero((weights.min(axis=1) > TINY) & (left <= SAME_NORMAL)):
            yield tuple(contacts[side == k] for k in choices[i]), weights[i] / weights[i].max()


def _squeeze(J_n: Array, sides: tuple[Indices, ...], w: Array, clearance: Array) -> Array | None:
    """Forces by which sides squeeze a body without moving it, of least sum w phi; or None.

    J_n, shape (n, n_v), holds rows of the contacts of all sides, one side after another. The forces
    of a side have the sum w of it [-]. None where they turn the body: then it is no guide.
    """
    from scipy.optimize import linprog  # takes as long as a short run

    of_side = np.repeat(np.eye(len(sides)), [len(side) for side in sides], axis=1)
    answer = linprog(
        clearance / max(clearance.max(), REPEATED),
        A_ub=np.vstack([J_n.T, -J_n.T]),
        b_ub=np.full(2 * J_n.shape[1], len(sides) * SAME_NORMAL),
        A_eq=of_side,
        b_eq=w,
    )
    return None if answer.status == INFEASIBLE else optimum(answer)


def guided(start: Start) -> Iterator[Finding]:
    """Contacts at the start that let a body crawl at most, once for each table and joint."""
    if start.points is None:
        return
    contacts = start.contacts_at_start
    reported: set[tuple[str, ...]] = set()
    for guide in guides(start, contacts):
        fastest = guide.clearance / (guide.mu * start.h)
        names = sorted({start.simulator.layout.names[j] for j in guide.contacts})
        joints = _joints(start, guide)
        key = (*names, *joints)
        under_coulomb = start.simulator.law == COULOMB
        if fastest >= CRAWL or key in reported or (under_coulomb and guide.clearance):
            continue
        reported.add(key)
        step = at_rest(start, start.q_start, contacts)
        if _holds(start, guide, step, squeezed=False):
            continue  # by its lever arms, and not because it is locked
        unit = "rad" if guide.turns else "m"
        cause = (
            f"{' and '.join(joints)} cannot open the gap of {' and '.join(names)}, "
            f"{1e3 * guide.clearance:.3g} mm, "
        )
        if under_coulomb:
            cause += "where Coulomb's law has many solutions, and a run takes the locked one"
        else:
            cause += (
                f"and a contact that slides has to rise: it moves by at most {fastest:.3g} "
                f"{unit}/s, whatever the force"
            )
        yield Finding(
            "guided-friction",
            True,
            _remedy(start, guide, step),
            cause,
            {"clearance_mm": 1e3 * guide.clearance, f"fastest_{unit}_per_s": fastest},
        )


def _by_lever_arms(run: Run, step: StepData, J_n: Array, wrench: Array) -> Array:
    """Normal forces that bear the loads of a step without a squeeze, shape (n_c,) [N].

    Contacts of actuated bodies are loads, as they press in the step.
    """
    actuated = step.contacts.J[:, :, : step.n_a].any(axis=(1, 2))
    pushed = step.tau_u + np.where(actuated, wrench[:, 2], 0.0) @ J_n
    touching = run.touching(step.contacts.phi) & ~actuated
    return unsqueezed(step.replace(tau_u=pushed), touching)


def _joints(start: Start, guide: Guide) -> list[str]:
    coordinates = start.system.coordinates
    return list(dict.fromkeys(coordinates[i].joint for i in np.flatnonzero(guide.moved)))


def _holds(start: Start, guide: Guide, step: StepData, squeezed: bool) -> bool:
    """Whether friction of a guide bears a free body that would fall without it."""
    joint = start.system.joint(_joints(start, guide)[0])
    name = joint.name.partition("/")[0]
    mu_v = step.contacts.mu_v.copy()
    mu_v[list(guide.contacts)] = 0.0
    smooth = step.replace(contacts=replace(step.contacts, mu_v=mu_v))
    return joint.free and borne(start, step, name, squeezed) and not borne(start, smooth, name)


def _remedy(start: Start, guide: Guide, step: StepData) -> str:
    of_mjcf = start.system.of_mjcf
    pairs = [start.pairs[i] for i in start.pair_of[list(guide.contacts)].tolist()]
    tables = " or ".join(sorted({table(start, pair) for pair in pairs}))
    joints = _joints(start, guide)
    joint = start.system.joint(joints[0])
    name = joint.name.partition("/")[0]
    if joint.free:
        if _holds(start, guide, step, squeezed=True):
            spring = "a position actuator" if of_mjcf else "a spring (K_q)"
            return f"let {spring} press one side of {tables}, so that friction holds {name}"
        mu = "condim = 1" if of_mjcf else f"{'mu_omega' if guide.turns else 'mu_v'} = 0"
        return f"give {tables} {mu}, or more clearance"
    if of_mjcf:
        return f"leave out {tables} (contact/exclude), and give {' and '.join(joints)} frictionloss"
    instead = "support" if isinstance(joint, Planar) else "joint_friction"
    return f"leave out {tables}, and say {instead} in [bodies.{name}]"


def locked(run: Run) -> Iterator[Finding]:
    """Free coordinates that guides hold against more than friction could, in the worst step.

    That is the step with most friction. What contacts could bear is their friction coefficients
    times the forces of the same step without friction: there, no guide presses because it is to
    rise. Lever arms press, too: a body that hangs beyond its guide is pressed on both sides of it.
    A coordinate is locked if it moves by less than a tenth of what it then would.
    """
    rubbing = np.abs(run["wrench"][:, :, [0, 1, 3]]).sum(axis=(1, 2))
    if not rubbing.any():
        return
    k = int(rubbing.argmax())
    contacts = run.at(k).contacts
    every = list(guides(run, contacts))
    if not every:
        return
    wrench = run.at(k).forces
    presses = pressing(wrench[:, 2])
    every = [guide for guide in every if presses[list(guide.contacts)].any()]
    if not every:
        return
    step = run.at(k).step
    smooth = run.solved(step.replace(cone="frictionless"))
    n_a = step.n_a
    J_n, *J_rubs = frame_jacobian(contacts, contacts.J[:, :, n_a:])
    force = step.tau_u + wrench[:, 2] @ J_n  # all but friction
    normal = np.maximum(smooth.wrench[:, 2], _by_lever_arms(run, step, J_n, wrench))
    could = np.einsum("icv,ci->v", np.abs(J_rubs), contacts.mu * normal[:, None])
    beyond = np.abs(force) - could
    moves = np.abs(run["delta_q"][k, n_a:]) >= LOCKED * run.h**2 * beyond / np.diag(step.M_u)
    stuck = (np.abs(force) > 2 * could) & ~moves
    reported: set[str] = set()
    for guide in every:
        held = np.flatnonzero(guide.moved[n_a:] & stuck)
        if not held.size or (joint := run.system.coordinates[n_a + held[0]].joint) in reported:
            continue
        reported.add(joint)
        i = int(held[beyond[held].argmax()])
        j = max(guide.contacts, key=lambda j: float(wrench[j, 2]))
        name = run.simulator.layout.names[j]
        coordinate = run.system.coordinates[n_a + i]
        unit = "N" if coordinate.unit == "m" else "N m"
        moved = amount(abs(float(run["delta_q"][k, n_a + i])), coordinate.unit)
        yield Finding(
            "locked-guide",
            True,
            _remedy(run, guide, at_rest(run, run["q"][k], contacts)),
            f"{coordinate.name} moves by {moved} under {abs(force[i]):.3g} {unit} in step {k}, "
            f"where its contacts could bear {could[i]:.3g} {unit}: {name} presses with "
            f"{wrench[j, 2]:.3g} N, because a contact that slides has to rise and it cannot",
            {"force": float(abs(force[i])), "could_bear": float(could[i]), "step": k},
        )
