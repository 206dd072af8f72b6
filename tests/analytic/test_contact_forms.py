"""Closed forms of single contacts: their rows, normals and gaps, of random instances."""

import numpy as np
from scipy.optimize import linprog, minimize

from quasistatic_ref import Box
from quasistatic_ref.lab.scenes.contacts import contacts_of, point_jacobian
from quasistatic_ref.lab.thresholds import exact
from quasistatic_ref.step.friction import friction_rows
from tests.analytic.instances import INFEASIBLE, INSTANCES, instances, near
from tests.contact.still import found_for, placed_shape, standing_links
from tests.oracles.random_steps import mixed_step


def random_contact(rng):
    """A frame d1, d2, n, its middle point and gap, and the centres of both bodies."""
    frame = np.linalg.qr(rng.normal(size=(3, 3)))[0].T
    frame[2] = np.cross(*frame[:2])
    point, *centres = rng.normal(size=(3, 3))
    return frame, point, rng.normal() * 0.1, centres


def jacobian(alpha, beta, n, centres):
    """J of two bodies by the twists at their centres, alpha's body first."""
    first, second = centres
    return np.hstack([-point_jacobian(alpha - first, n), point_jacobian(beta - second, n)])


def test_r20_one_contact_point_instead_of_two(rng):
    """Rows differ by +- mu (phi / 2) (n x t_k).(omega_1 + omega_2) along tangents, and not else."""
    for _, _, mu_v, mu_omega in instances(rng):
        frame, p, phi, centres = random_contact(rng)
        d1, d2, n = frame
        half = phi / 2 * n
        ours, theirs = (
            friction_rows(contacts_of(phi, frame, J[None], mu_v, mu_omega, rows=6))
            for J in (jacobian(p - half, p + half, n, centres), jacobian(p, p, n, centres))
        )
        twists = rng.normal(size=12)
        turns = twists[3:6] + twists[9:]
        along, across = (mu_v * phi / 2 * np.cross(n, t) @ turns for t in (d1, d2))
        near((ours - theirs)[0] @ twists, [along, across, -along, -across, 0, 0], 100.0)


def common(A, B, n):
    """How far points that two convex hulls have in common are along n; None without one."""
    weights = np.block([
        [A.T, -B.T], [np.ones(len(A)), np.zeros(len(B))], [np.zeros(len(A)), np.ones(len(B))],
    ])  # fmt: skip
    height = np.append(A @ n, np.zeros(len(B)))
    found = [linprog(s * height, A_eq=weights, b_eq=[0, 0, 0, 1, 1]) for s in (1, -1)]
    return None if found[0].status == 2 else [found[0].fun, -found[1].fun]


def nearest_in_hull(A, p):
    """The point of a convex hull nearest to p."""
    start = np.full(len(A), 1 / len(A))
    whole = {"type": "eq", "fun": lambda w: w.sum() - 1, "jac": np.ones_like}
    found = minimize(lambda w: ((w @ A - p) ** 2).sum(), start, jac=lambda w: 2 * A @ (w @ A - p),
                     bounds=[(0, 1)] * len(A), constraints=whole, tol=1e-14)  # fmt: skip
    return found.x @ A


def test_r37_contacts_of_convex_bodies_share_a_normal(rng, both):
    """Across n nothing meets, though a row along another normal would stop it.

    Hulls of points on both sides of a plane across n; where they touch, what they share is on it.
    """
    for k in range(INSTANCES):
        n = np.linalg.qr(rng.normal(size=(3, 3)))[0][0]
        phi = rng.choice([0.0, rng.random()])
        A = rng.normal(size=(6, 3))
        A -= A[np.argmax(A @ n)]  # 0 is the highest point
        B = rng.normal(size=(6, 3))
        B += phi * n - B[np.argmin(B @ n)]
        if k % 2:  # more points in the plane
            A[1:4] -= np.outer(A[1:4] @ n, n)
            B[1:4] -= np.outer(B[1:4] @ n - phi, n)
        p = B[rng.integers(6)]
        away = p - nearest_in_hull(A, p)
        gap = np.linalg.norm(away)
        m = away / gap if gap > 1e-3 else n
        aside = m - (m @ n) * n
        both(np.linalg.norm(aside) > 1e-3, phi)
        v = rng.normal(size=3)
        v -= (v @ n) * n
        if np.linalg.norm(aside) > 1e-3:
            v = -1.01 * gap * aside / (aside @ aside)
            assert gap + m @ v < 0
        met = common(A, B + v, n)
        if phi:
            assert met is None
        elif met is not None:
            np.testing.assert_allclose(met, 0.0, atol=1e-7)


def test_bodies_that_are_apart_may_come_to_touch_along_another_normal():
    """A box that moves from diagonally above an edge of another onto its top, without a turn."""
    large, small = (
        placed_shape(Box(np.full(3, half)), link) for half, link in ((0.1, 1), (0.01, 2))
    )
    for xyz, n in (([0.12, 0, 0.12], [np.sqrt(0.5), 0, np.sqrt(0.5)]), ([0, 0, 0.11], [0, 0, 1])):
        where = standing_links((np.eye(3), np.zeros(3)), (np.eye(3), np.array(xyz)))
        near(found_for(large, small, where).n, [n], 1.0)


def test_r19_the_gap_of_a_loaded_contact(rng, both):
    """Phi + n'nu = max(mu_v |nu_1|, mu_v |nu_2|, mu_omega |omega_n|): zero where it sticks."""
    for seed in range(INSTANCES):
        if seed in INFEASIBLE:
            continue
        step = mixed_step(seed)
        answer = exact(step)
        c = step.contacts
        for j in np.flatnonzero(answer.wrench[:, 2] > 0):
            nu = c.J[j] @ answer.delta_q
            spin = c.mu_omega[j] * nu[3] * (c.rows[j] == 6)
            slips = np.abs([c.mu_v[j] * c.d1[j] @ nu[:3], c.mu_v[j] * c.d2[j] @ nu[:3], spin])
            size = np.abs(c.J[j]) @ np.abs(answer.delta_q)
            near(c.phi[j] + c.n[j] @ nu[:3], slips.max(), size.sum() + abs(c.phi[j]))
            both(slips.max() > 1e-9)
