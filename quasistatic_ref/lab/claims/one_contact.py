"""One contact: what it bears, how a point slides and a sphere spins on it, its spurious couple."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison, sum_of_terms
from quasistatic_ref.lab.made_steps.contacts import GRAVITY, contacts_of, point_jacobian
from quasistatic_ref.lab.made_steps.rigid import free_step, point_step, sphere_step
from quasistatic_ref.lab.thresholds import exact, grid, thresholds
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

# One contact loaded with a force and a torque at once.

LOADED_M = 0.3
LOADED_INERTIA = 3e-4
MU_V = 0.4
MU_OMEGA = 0.015
H = 0.01
LOADED_RADIUS = 1 / 16
"""A power of two: the torque of the force, were it rounded, would make the sphere roll [m]."""


def _loaded_contact(share: float, phi: float, *direction: float) -> StepData:
    """A share of (f_1, f_2, tau_n), in units of what each alone holds, at the contact point."""
    N = LOADED_M * GRAVITY - LOADED_M * phi / H**2
    f1, f2, tau = share * np.array(direction) * [MU_V * N, MU_V * N, MU_OMEGA * N]
    # The point is a radius below the centre: (0, 0, -r) x f.
    wrench = (f1, f2, -LOADED_M * GRAVITY, LOADED_RADIUS * f2, -LOADED_RADIUS * f1, tau)
    return sphere_step(
        LOADED_M, LOADED_INERTIA, LOADED_RADIUS, wrench, mu_v=MU_V, mu_omega=MU_OMEGA, phi=phi, h=H
    )


def octahedron_evidence() -> list[Comparison]:
    """The least load that moves a contact, along random directions, against the octahedron."""
    rng = np.random.default_rng(3)
    directions = rng.normal(size=(24, 3))
    gaps = H**2 * GRAVITY * rng.uniform(-1.0, 0.9, size=24)
    limits = 1 / np.abs(directions).sum(axis=1)
    sweep = np.column_stack([gaps, directions])
    along_floor = [0, 1, 5]  # x, y and the turn; z closes the gap at any load
    loads = thresholds(_loaded_contact, sweep, limits, (0.1, 3.0), along_floor)
    return [comparison("load that moves it, over the limit [-]", loads / limits, 1.0, CLOSED_FORM)]


OCTAHEDRON = Claim(
    name="octahedron",
    sentence="Tangential and torsional friction share one normal force: |f_1|/mu_v + |f_2|/mu_v + "
    "|tau_n|/mu_omega <= f_n.",
    where="docs/derivations.md (R9); the paper, Eqs. (4)-(7)",
    sweep="24 random directions of (f_1, f_2, tau_n), gaps from -1 to 1 mm; each threshold by "
    "bisection on exact answers",
    reason="CLOSED_FORM, above the 1e-13 at which the bisection stops.",
    measure=octahedron_evidence,
)

# A point on the floor, pulled in any direction.

POINT_M = 0.3
POINT_STEPS = 15


def point_displacement(fx: float, fy: float, mu: float, phi: float, h: float = H) -> Array:
    """The displacement of one step, shape (3,) [m]."""
    return exact(point_step(POINT_M, (fx, fy, -POINT_M * GRAVITY), mu, phi, h)).delta_q


def slip(fx: float, fy: float, mu: float, phi: float, h: float = H) -> Array:
    """Slip of a pushed point, shape (3,), by the closed form for forces fx >= fy >= 0."""
    if phi - h**2 * GRAVITY >= mu * h**2 * fx / POINT_M:
        return h**2 * np.array([fx / POINT_M, fy / POINT_M, -GRAVITY])
    load = mu * POINT_M * GRAVITY
    one = (h**2 * (fx - load) + POINT_M * mu * phi) / (POINT_M * (1 + mu**2))
    both = (h**2 * (fx + fy - load) + POINT_M * mu * phi) / (POINT_M * (2 + mu**2))
    free = h**2 * fy / POINT_M
    if one >= free and one > 0:
        return np.array([one, free, mu * one - phi])
    if both > 0:
        return np.array([both, both, mu * both - phi])
    return np.array([0.0, 0.0, -phi])


def pushed_point(share: float, angle: float, mu: float) -> StepData:
    """A point under a share of mu m g, at an angle from d1 [rad]."""
    f1, f2 = share * mu * POINT_M * GRAVITY * np.array([np.cos(angle), np.sin(angle)])
    return point_step(POINT_M, (f1, f2, -POINT_M * GRAVITY), mu, 0.0, H)


def threshold_evidence() -> list[Comparison]:
    """The least force that moves the point, by direction."""
    angles = np.radians(np.linspace(0.0, 90.0, 13))
    sweep = grid(angles, (0.2, 1.0))
    at = sweep[:, 0]
    expected = 1 / (np.cos(at) + np.sin(at))
    measured = thresholds(pushed_point, sweep, expected)
    what = "least force that moves it, over mu_v m g [-]"
    return [comparison(what, measured, expected, CLOSED_FORM)]


def slip_evidence() -> list[Comparison]:
    """One step in each regime of a contact, and then a sequence of steps along an axis."""
    solved = []
    formula = []
    scale = []
    sweep = grid(
        [0, 0.5, 0.9, 1.1, 2.0], [0, 0.1, 0.45], [0.2, 0.5, 1.0], [-1e-5, 0, 1e-4], [1e-3, H]
    )
    for share, side, mu, phi, h in sweep:
        fx = share * mu * POINT_M * GRAVITY
        solved.append(point_displacement(fx, side * fx, mu, phi, h))
        formula.append(slip(fx, side * fx, mu, phi, h))
        scale.append(max(h**2 * GRAVITY * max(1.0, share) * mu, abs(phi)))
    gaps = []
    mus, shares = grid([0.2, 0.5, 1.0], [1.2, 3.0]).T[:, :, None]
    for mu, share in zip(mus.flat, shares.flat, strict=True):
        phi = 0.0
        for _ in range(POINT_STEPS):
            gaps.append(phi)
            phi += float(point_displacement(share * mu * POINT_M * GRAVITY, 0.0, mu, phi)[2])
    layer = mus * H**2 * (shares - 1) * mus * GRAVITY
    rest = -layer * (mus**2 / (1 + mus**2)) ** np.arange(POINT_STEPS)
    gaps_of = np.reshape(gaps, rest.shape)
    return [
        comparison("delta_q [m]", solved, formula, CLOSED_FORM, np.array(scale)[:, None]),
        sum_of_terms("phi_k while sliding [m]", gaps_of, [layer, rest], CLOSED_FORM),
    ]


THRESHOLD = Claim(
    name="sliding_threshold",
    sentence="The pyramid holds mu_v N along its axes and mu_v N / sqrt 2 between them: (|cos| + "
    "|sin|) F <= mu_v N.",
    where="docs/derivations.md (R7)",
    sweep="13 directions, two mu_v; each threshold by bisection on exact answers",
    reason="CLOSED_FORM, above the 1e-13 at which the bisection stops.",
    measure=threshold_evidence,
)

SLIP = Claim(
    name="sliding_point",
    sentence="A point that is pulled slides as a closed form says: off the floor, stuck, or with "
    "one or two rows at their limits. While it slides, its gap tends to mu_v times the slip of a "
    "step, at the rate mu_v^2 / (1 + mu_v^2).",
    where="docs/derivations.md (R8)",
    sweep="forces, directions, mu_v, gaps and time steps: 270 steps; six sequences of 15 steps",
    reason="CLOSED_FORM, relative to the largest term of the slip.",
    measure=slip_evidence,
)

# A sphere on the floor under a constant torque about the normal.

SPHERE_M = 0.3
SPHERE_INERTIA = 3e-4
SPHERE_RADIUS = 0.05
SPHERE_STEPS = 20
STARTS = (-1e-6, 0.0, 1e-6, 2e-4)
"""Gaps to start from [m]: so little penetration that the sphere turns in the first step already."""


def one_step(tau: float, phi: float, h: float, mu_omega: float) -> tuple[float, float]:
    """Rise and turn (delta_z, delta_theta) of a turned sphere in a solved step."""
    wrench = (0, 0, -SPHERE_M * GRAVITY, 0, 0, tau)
    delta_q = exact(
        sphere_step(
            SPHERE_M,
            SPHERE_INERTIA,
            SPHERE_RADIUS,
            wrench,
            mu_v=0.5,
            mu_omega=mu_omega,
            phi=phi,
            h=h,
        )
    ).delta_q
    return float(delta_q[2]), float(delta_q[5])


def step_evidence() -> list[Comparison]:
    """One step of a sphere that sticks, turns on the floor or turns above it, against a formula."""
    limits = [0.0, 0.5, 0.999, 1.001, 1.5, 5.0]
    sweep = grid(limits, [-1e-4, 0.0, 1e-5, 3e-3], [1e-3, 1e-2, 0.05], [0.002, 0.02])
    share, phi, h, mu = sweep.T
    tau = share * mu * SPHERE_M * GRAVITY
    solved = np.array([one_step(*x) for x in zip(tau, phi, h, mu, strict=True)])
    # The sum of three terms over I + m mu^2, held between standing still and turning freely.
    terms = np.array([h**2 * tau, -(h**2) * mu * SPHERE_M * GRAVITY, SPHERE_M * mu * phi]) / (
        SPHERE_INERTIA + SPHERE_M * mu**2
    )
    theta = np.clip(terms.sum(0), 0.0, h**2 * tau / SPHERE_INERTIA)
    rise = np.maximum(mu * theta - phi, -(h**2) * GRAVITY)
    largest = np.abs(terms).max(0)
    return [
        comparison("delta_theta [rad]", solved[:, 1], theta, CLOSED_FORM, largest),
        comparison(
            "delta_z [m]", solved[:, 0], rise, CLOSED_FORM, np.maximum(mu * largest, abs(phi))
        ),
    ]


def sequence(tau: float, phi: float, h: float, mu: float) -> Array:
    """Gap before each of some steps, shape (k,) [m]."""
    gaps = []
    for _ in range(SPHERE_STEPS):
        gaps.append(phi)
        phi += one_step(tau, phi, h, mu)[0]
    return np.array(gaps)


def recurrence_evidence() -> list[Comparison]:
    """Gaps of a turning sphere, step after step, from several first gaps, against a formula."""
    sweep = grid(STARTS, [1.2, 3.0], [1e-3, 1e-2], [0.01, 0.05])
    start, share, h, mu = sweep[sweep[:, 0] <= sweep[:, 2] ** 2 * GRAVITY].T  # others fall first
    limit = mu * SPHERE_M * GRAVITY
    ratio = SPHERE_M * mu**2 / (SPHERE_INERTIA + SPHERE_M * mu**2)
    layer = mu * h**2 * (share - 1) * limit / SPHERE_INERTIA
    gaps = [sequence(*of) for of in zip(share * limit, start, h, mu, strict=True)]
    left = (start - layer)[:, None] * ratio[:, None] ** np.arange(SPHERE_STEPS)
    return [sum_of_terms("phi_k [m]", gaps, [layer[:, None], left], CLOSED_FORM)]


STEP = Claim(
    name="spinning_sphere_step",
    sentence="A torque about the normal turns a sphere only beyond mu_omega N, and then lifts it "
    "by mu_omega times the turn.",
    where="docs/derivations.md (R5)",
    sweep="six torques, four gaps, three time steps, two mu_omega",
    reason="CLOSED_FORM, relative to the largest of the three terms of the turn.",
    measure=step_evidence,
)

RECURRENCE = Claim(
    name="spinning_sphere_recurrence",
    sentence="The gap of a spun sphere goes to mu_omega h^2 (tau - mu_omega m g) / I, "
    "geometrically, at the rate m mu_omega^2 / (I + m mu_omega^2), from any gap at which it turns "
    "in contact.",
    where="docs/derivations.md (R6)",
    sweep="gaps, torques, time steps and mu_omega, 20 steps each",
    reason="CLOSED_FORM, relative to the larger of layer and what is left of the start.",
    measure=recurrence_evidence,
)

# Two free bodies across a gap: the pair of contact forces is a couple.

BALL_M = (0.3, 0.5)
BALL_INERTIA = (2e-4, 4e-4)
BALL_RADIUS = (0.03, 0.04)


def pressed_balls(phi: float, n: np.ndarray, d1: np.ndarray, force: np.ndarray) -> StepData:
    """Two balls, pressed together and sheared by opposite forces at their centres."""
    J = np.zeros((1, 4, 12))
    J[0, :, :6] = -point_jacobian(BALL_RADIUS[0] * n, n)  # alpha
    J[0, :, 6:] = point_jacobian(-BALL_RADIUS[1] * n, n)  # beta
    moments = np.repeat(np.stack([BALL_M, BALL_INERTIA], axis=1), 3, axis=1).ravel()
    load = np.concatenate([force, np.zeros(3), -force, np.zeros(3)])
    contact = contacts_of(phi, [[d1, np.cross(n, d1), n]], J, 0.6, 0.01, rows=6)
    return free_step(np.diag(moments), load, contact, H)


def couple_evidence() -> list[Comparison]:
    """Spurious angular impulse of two bodies at several gaps, under random loads, against (R18)."""
    rng = np.random.default_rng(4)
    changes = []
    forces = []
    couples = []
    sizes = []
    balance = []
    for phi in (-1e-3, -1e-5, 0.0, 1e-5, 2e-4):
        for _ in range(6):
            n, d1 = np.linalg.qr(rng.normal(size=(3, 3)))[0].T[:2]
            force = rng.uniform(20, 60) * n + rng.normal(size=3) * 3
            step = pressed_balls(phi, n, d1, force)
            answer = exact(step)
            f_d1, f_d2, f_n, _ = answer.wrench[0]
            f = f_d1 * d1 + f_d2 * np.cross(n, d1) + f_n * n
            impulse = step.M_u @ answer.delta_q / H - H * step.tau_u
            P1, L1, P2, L2 = impulse.reshape(4, 3)
            at1, at2 = np.zeros(3), (BALL_RADIUS[0] + BALL_RADIUS[1] + phi) * n  # centres
            changes.append(np.cross(at1, P1) + L1 + np.cross(at2, P2) + L2)
            couples.append(H * phi * np.cross(n, f))
            sizes.append(H * np.linalg.norm(f) * BALL_RADIUS[1])
            forces.append(np.linalg.norm(f) * H)
            balance.append(P1 + P2)
    scale = np.array(sizes)[:, None]
    size = np.array(forces)[:, None]
    return [
        comparison(
            "spurious angular impulse of the pair [N m s]", changes, couples, CLOSED_FORM, scale
        ),
        comparison("impulse of the pair [N s]", balance, np.zeros_like(balance), CLOSED_FORM, size),
    ]


COUPLE = Claim(
    name="spurious_couple",
    sentence="The two forces of a contact act at alpha and at beta: while phi != 0 they are a "
    "couple phi n x f on the pair, though their sum is zero.",
    where="docs/derivations.md (R18)",
    sweep="five gaps from -1 mm to 0.2 mm, six random normals and loads each",
    reason="CLOSED_FORM, relative to the moment of the force about a centre.",
    measure=couple_evidence,
)
