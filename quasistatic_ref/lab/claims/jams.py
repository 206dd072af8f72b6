"""What jams: a peg in its hole, and a guide."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison
from quasistatic_ref.lab.made_steps.contacts import X, Y, Z, contacts_of
from quasistatic_ref.lab.made_steps.rigid import free_step, rigid_step
from quasistatic_ref.lab.thresholds import exact, grid, thresholds
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.tolerances import CLOSED_FORM

# A peg that touches its hole at two points: wedged, or free to go in (Whitney 1982).
#
# (R17): for a descent s, a turn theta and a motion x across the hole, the rows of the two contacts
# are x + theta l / 2 >= mu |s - theta d / 2| and -x + theta l / 2 >= mu |s + theta d / 2|. Their
# sum, theta l >= mu max(2 s, theta d), has a solution with s > 0 if and only if l >= mu d, because
# the larger of the two terms is at least theta d. For l > mu d both rows are tight, and both
# multipliers are positive if I + mu^2 m d^2 / 4 >= mu m d l / 4, as for every uniform rectangle of
# height at least l.

PEG_M = 0.3
H = 0.01
PEG_INERTIA = 2e-3
"""Of a peg long enough that both contacts go on pressing while it slides in [kg m^2]."""


def pushed_peg(depth: float, width: float, mu: float, force: float) -> StepData:
    """A peg pushed down by a force on its axis.

    It touches the mouth of the hole at its left and the wall at its right, `depth` lower and
    `width` apart; the centre of mass is midway.
    """
    points = [[-width / 2, 0.0, depth / 2], [width / 2, 0.0, -depth / 2]]
    frames = [[Y, Z, X], [Y, -Z, -X]]
    return rigid_step(PEG_M, PEG_INERTIA, (0, 0, -force, 0, 0, 0), points, frames, mu_v=mu, h=H)


def peg_evidence() -> list[Comparison]:
    """Depths at which a peg wedges under weak and strong pushes, and where it slides on."""
    sweep = grid([0.01, 0.04], [0.1, 0.3, 0.8], [1e-3, 1.0, 1e6])
    widths, mus, _ = sweep.T
    expected = mus * widths
    measured = thresholds(pushed_peg, sweep, expected, (0.2, 5.0))
    wedged = (pushed_peg(0.99 * limit, *of) for limit, of in zip(expected, sweep, strict=True))
    rest = [exact(step).delta_q for step in wedged]
    width, mu, over, force = grid([0.01, 0.04], [0.1, 0.3, 0.8], [1.05, 2, 6], [0.1, 5.0]).T
    depth = over * mu * width
    pegs = zip(depth, width, mu, force, strict=True)
    solved = [exact(pushed_peg(*of)).delta_q for of in pegs]
    theta, x = 2 * mu / depth, -(mu**2) * width / depth  # per unit of descent
    descent = H**2 * force / (PEG_M * (1 + x**2) + PEG_INERTIA * theta**2)
    none = 0 * x
    formula = (descent * np.array([x, none, none - 1, none, theta, none])).T
    size = np.abs(formula).max(1, keepdims=True)
    return [
        comparison("depth below which it wedges [m]", measured, expected, CLOSED_FORM, expected),
        comparison("motion of a wedged peg [m, rad]", rest, 0.0, 0.0),
        comparison("motion of one that slides in [m, rad]", solved, formula, CLOSED_FORM, size),
    ]


PEG = Claim(
    name="peg_wedging",
    sentence="A peg that touches its hole on both sides wedges at depths l < mu d, however hard "
    "it is pushed; deeper, it slides in, turning by 2 mu / l for each unit of descent.",
    where="docs/derivations.md (R17); D. E. Whitney, J. Dyn. Sys. Meas. Control 104 (1982), 65-77",
    sweep="two widths, three mu, pushes of 1 mN to 1 MN, three depths beyond the limit",
    reason="CLOSED_FORM; a wedged peg does not move at all, bit for bit.",
    measure=peg_evidence,
)

# A body between two walls: how far it can slide or turn in a step, whatever pushes it.

GUIDE_M = 0.5
GUIDE_INERTIA = 2e-4
MU_V = 0.5
MU_OMEGA = 0.01
WALLS = [[[1, 0, 0], [0, 0, -1], [0, 1, 0]], [[1, 0, 0], [0, 0, 1], [0, -1, 0]]]
"""Rows d1, d2, n of two walls that face each other along y."""
ACROSS = [0.0, 1.0, 0.0]


def guide_step(force: float, angle: float, phi: float) -> StepSolution:
    """One step of a point midway between the walls, with the gap phi to each [m].

    The force [N] is in their plane, at an angle [rad] from d1.
    """
    push = force * np.array([np.cos(angle), 0.0, np.sin(angle)])
    contacts = contacts_of(phi, WALLS, np.tile(np.eye(4, 3), (2, 1, 1)), MU_V)
    return exact(free_step(GUIDE_M * np.eye(3), push, contacts, H))


def guide_turn(torque: float, phi: float) -> float:
    """Turn about y [rad] of a body under a torque [N m], with the gap phi to each wall [m].

    It moves along y and turns about it.
    """
    J = np.zeros((2, 4, 2))
    J[:, :3, 0] = ACROSS
    J[:, 3, 1] = [1.0, -1.0]
    contacts = contacts_of(phi, WALLS, J, 0.0, MU_OMEGA, 6)
    step = free_step(np.diag([GUIDE_M, GUIDE_INERTIA]), [0.0, torque], contacts, H)
    return float(exact(step).delta_q[1])


def locked_guide_evidence() -> list[Comparison]:
    """Slips and turns of a body between walls, under small to huge loads, against a formula."""
    shares = [0.01, 0.5, 0.99, 1.01, 2.0, 1e3, 1e6]
    gaps = [0.0, 1e-5, 1e-3]
    share, angle, phi = grid(shares, np.radians([0.0, 20.0, 45.0, 90.0]), gaps).T
    force = share * GUIDE_M * np.maximum(phi, 1e-5) / (MU_V * H**2)
    free = H**2 * force / GUIDE_M * np.array([np.cos(angle), np.sin(angle)])
    slips = np.minimum(free, phi / MU_V)
    answers = [guide_step(*of) for of in zip(force, angle, phi, strict=True)]
    moved = np.array([answer.delta_q[[0, 2]] for answer in answers]).T
    # What does not move the body, the walls bear: mu_v N along each tangent.
    pressed = MU_V * np.array([answer.wrench[:, 2].sum() for answer in answers]) / force
    balance = (GUIDE_M / H**2 * (free - slips)).sum(axis=0) / force
    share, phi = grid(shares, gaps).T
    torque = share * GUIDE_INERTIA * np.maximum(phi, 1e-5) / (MU_OMEGA * H**2)
    turns = [guide_turn(*of) for of in zip(torque, phi, strict=True)]
    limits = np.minimum(H**2 * torque / GUIDE_INERTIA, phi / MU_OMEGA)
    scale = np.abs(slips).max(axis=0) + 1e-5
    return [
        comparison("slip along d1 and d2 [m]", moved, slips, CLOSED_FORM, scale),
        comparison("mu_v times the load of the walls, over the force [-]", pressed, balance,
                   CLOSED_FORM, 1.0),
        comparison("turn [rad]", turns, limits, CLOSED_FORM, 1.0),
    ]  # fmt: skip


LOCKED_GUIDE = Claim(
    name="locked_guide",
    sentence="With a gap phi to each of two walls a body moves by at most phi / mu_v a step "
    "along each tangent, sqrt 2 of that between them, and turns by at most phi / mu_omega, "
    "whatever the force; the walls bear the rest.",
    where="docs/derivations.md (R38)",
    sweep="seven forces up to a million times the limit's, four directions, three gaps",
    reason="CLOSED_FORM, relative to the larger of motion and 10 um.",
    measure=locked_guide_evidence,
)
