"""The comparison with MuJoCo: the formula of its contact point, and what its absence does."""

import numpy as np

from quasistatic_ref.contact.jacobian import contact_jacobian
from quasistatic_ref.lab.claims.claim import FAILS, HOLDS, claim_result
from quasistatic_ref.lab.claims.engines import mujoco_rows
from quasistatic_ref.lab.claims.engines.mujoco_rows import rows_of
from quasistatic_ref.lab.claims.engines.mujoco_scenes import heap
from quasistatic_ref.lab.scenes.contacts import contacts_of
from quasistatic_ref.step.friction import friction_rows
from tests.closeness import assert_within
from tests.helpers import random_frame
from tests.tolerances import ROUNDING


def test_one_point_midway_changes_tangential_rows_by_the_formula(rng):
    # Rows with alpha = p - phi/2 n and beta = p + phi/2 n, minus rows with both at p, are
    # +- mu_k (phi/2) (n x t_k).(omega_1 + omega_2); torsional rows do not differ.
    system = heap(3).system
    kinematics = system.kinematics(system.q_start)
    d1, d2, n = random_frame(rng)
    p = rng.normal(size=3)
    phi = 0.03
    mu = 0.7
    one = np.array([1])
    two = np.array([2])

    def rows(half):
        J = contact_jacobian(kinematics, one, two, (p - half)[None], (p + half)[None], n[None])
        return friction_rows(contacts_of(phi, [[d1, d2, n]], J, mu, 0.02, (6,)))[0]

    omega = kinematics.J[1, 3:] + kinematics.J[2, 3:]
    t1, t2 = (mu * phi / 2 * np.cross(n, t) @ omega for t in (d1, d2))
    expected = np.array([t1, t2, -t1, -t2, 0 * t1, 0 * t1])
    assert np.abs(expected).max() > 1e-4
    difference = rows(phi / 2 * n) - rows(np.zeros(3))
    assert_within(difference, expected, ROUNDING)


def test_without_the_formula_the_rows_do_not_agree(monkeypatch):
    def without(scene):
        rows = rows_of(scene)
        return rows | {"shift": 0 * rows["shift"]}

    assert claim_result(mujoco_rows.CLAIM).verdict == HOLDS
    monkeypatch.setattr(mujoco_rows, "rows_of", without)
    found = claim_result(mujoco_rows.CLAIM)
    assert found.verdict == FAILS
    # It is the tangential rows that suffer, and the torsional ones that do not.
    holds = {c.what.split()[0]: c.holds for c in found.evidence.comparisons}
    assert not holds["tangential"]
    assert holds["torsional"]
