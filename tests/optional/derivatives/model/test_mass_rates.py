"""Rates of the mass matrix and of gravity's force, by differences, on random trees of links."""

import numpy as np
import pytest

from quasistatic_ref.lab.vectors.challenge.random_mechanisms import random_q, random_tree
from quasistatic_ref.lab.vectors.own.system import own_system
from quasistatic_ref.optional.derivatives.model.mass_rates import MassRates
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from tests.oracles.differences import rate
from tests.tolerances import DIFFERENCE

GRAVITY = np.array([1.0, -2.0, -9.81])


@pytest.mark.parametrize("base", ["floating", "planar"])
def test_inertial_and_gravity_forces_change_as_differences_say(base):
    rng = np.random.default_rng(4)
    tree = random_tree(rng, 6, base, masses=True)
    for body in tree["bodies"]:
        body["actuated"] = False
    own = own_system(tree)
    system = own.system
    q = system.integrate(own.model_q(random_q(rng, tree)), np.zeros(system.n_v))
    kinematics = system.kinematics(q)
    rates = MassRates(system, kinematics, MotionRates(kinematics, system.column_map))
    x = rng.normal(size=system.n_v)

    def forces(delta_q):
        moved = system.integrate(q, delta_q)
        return np.stack([system.M_u(moved) @ x, system.gravity_force(moved, GRAVITY)], axis=1)

    found = np.stack([rates.inertial_force_rates(x), rates.gravity_rates(GRAVITY)], axis=1)
    for k, e in enumerate(np.eye(system.n_v)):
        expected = rate(lambda t, e=e: forces(t * e))
        size = np.abs(expected).max(initial=1.0)
        np.testing.assert_allclose(found[:, :, k], expected, rtol=0, atol=DIFFERENCE * size)
