"""Closed forms of single contacts: their rows, normals and gaps, of random instances."""

import numpy as np

from quasistatic_ref import convex_hull
from quasistatic_ref.step.standard_form import friction_rows
from tests.analytic.instances import INFEASIBLE, INSTANCES, exact, instances, near
from tests.contact.still import in_world, solid_pair
from tests.made import contacts_of, point_jacobian, random_frames
from tests.oracles.random_steps import drawn


def test_r20_one_contact_point_instead_of_two(rng):
    """Rows differ by +- mu (phi / 2) (n x t_k).(omega_1 + omega_2) along tangents, and not else."""
    for _, _, mu_v, mu_omega in instances(rng):
        d1, d2, n = frame = random_frames(rng, 1)[0]
        point, *centres = rng.normal(size=(3, 3))
        phi = rng.normal() * 0.1

        def rows(half, p=point, places=centres, gap=phi, of=frame, mu=(mu_v, mu_omega)):
            ends = zip((p - half, p + half), places, (-1, 1), strict=True)
            J = [sign * point_jacobian(end - centre, of[2]) for end, centre, sign in ends]
            return friction_rows(contacts_of(gap, of, np.hstack(J)[None], *mu, rows=6))[0]

        twists = rng.normal(size=12)
        turns = twists[3:6] + twists[9:]
        along, across = (mu_v * phi / 2 * np.cross(n, t) @ turns for t in (d1, d2))
        found = (rows(phi / 2 * n) - rows(np.zeros(3))) @ twists
        near(found, [along, across, -along, -across, 0, 0], 100.0)


def test_r37_convex_bodies_share_a_normal(rng):
    """Moved square to it they come no nearer, whichever points face each other then."""
    for k in range(INSTANCES):
        one, other = (convex_hull(rng.normal(size=(6, 3))) for _ in "ab")
        t = 9.0 * random_frames(rng, 1)[0, 0]
        apart = solid_pair("p", in_world(one), in_world(other, t))
        t = t - (k % 2) * apart.phi * apart.n  # or in touch
        v = np.cross(apart.n, rng.normal(size=3))
        moved = solid_pair("p", in_world(one), in_world(other, t + v))
        assert moved.phi >= (1 - k % 2) * apart.phi - 1e-12


def test_r19_the_gap_of_a_loaded_contact():
    """Phi + n'nu = max(mu_v |nu_1|, mu_v |nu_2|, mu_omega |omega_n|): zero where it sticks."""
    slides = set()
    for seed in set(range(INSTANCES)) - INFEASIBLE:
        step = drawn(seed)
        answer = exact(step)
        c = step.contacts
        for j in np.flatnonzero(answer.wrench[:, 2] > 0):
            nu = c.J[j] @ answer.delta_q
            spin = c.mu_omega[j] * nu[3] * (c.rows[j] == 6)
            slips = np.abs([c.mu_v[j] * c.d1[j] @ nu[:3], c.mu_v[j] * c.d2[j] @ nu[:3], spin])
            size = np.abs(c.J[j]) @ np.abs(answer.delta_q)
            near(c.phi[j] + c.n[j] @ nu[:3], slips.max(), size.sum() + abs(c.phi[j]))
            slides.add(slips.max() > 1e-9)
    assert len(slides) == 2
