"""Two free bodies across a gap: the pair of contact forces is a couple."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.contacts import contacts_of, point_jacobian
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.lab.thresholds import exact
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

M = (0.3, 0.5)
INERTIA = (2e-4, 4e-4)
RADIUS = (0.03, 0.04)
H = 0.01


def pressed_balls(phi: float, n: np.ndarray, d1: np.ndarray, force: np.ndarray) -> StepData:
    """Two balls, pressed together and sheared by opposite forces at their centres."""
    J = np.zeros((1, 4, 12))
    J[0, :, :6] = -point_jacobian(RADIUS[0] * n, n)  # alpha
    J[0, :, 6:] = point_jacobian(-RADIUS[1] * n, n)  # beta
    moments = np.repeat(np.stack([M, INERTIA], axis=1), 3, axis=1).ravel()
    load = np.concatenate([force, np.zeros(3), -force, np.zeros(3)])
    contact = contacts_of(phi, [[d1, np.cross(n, d1), n]], J, 0.6, 0.01, rows=6)
    return free_step(np.diag(moments), load, contact, H)


def evidence() -> Evidence:
    """Gaps of both signs, normals and loads at random."""
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
            at1, at2 = np.zeros(3), (RADIUS[0] + RADIUS[1] + phi) * n  # centres
            changes.append(np.cross(at1, P1) + L1 + np.cross(at2, P2) + L2)
            couples.append(H * phi * np.cross(n, f))
            sizes.append(H * np.linalg.norm(f) * RADIUS[1])
            forces.append(np.linalg.norm(f) * H)
            balance.append(P1 + P2)
    scale = np.array(sizes)[:, None]
    size = np.array(forces)[:, None]
    return Evidence.of(
        comparison(
            "spurious angular impulse of the pair [N m s]", changes, couples, CLOSED_FORM, scale
        ),
        comparison("impulse of the pair [N s]", balance, np.zeros_like(balance), CLOSED_FORM, size),
    )


CLAIM = Claim(
    name="spurious_couple",
    sentence="The two forces of a contact act at alpha and at beta: while phi != 0 they are a "
    "couple phi n x f on the pair, though their sum is zero.",
    where="docs/derivations.md (R18)",
    sweep="five gaps from -1 mm to 0.2 mm, six random normals and loads each",
    reason="CLOSED_FORM, relative to the moment of the force about a centre.",
    measure=evidence,
)
