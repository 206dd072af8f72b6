"""Rates of the mass matrix and of gravity's force, by differences, on random trees of links."""

import numpy as np
import pytest

from quasistatic_ref.lab.vectors.challenge.random_mechanisms import random_q, random_tree
from quasistatic_ref.lab.vectors.own.system import own_system
from quasistatic_ref.optional.derivatives.model.mass_rates import MassRates
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from tests.closeness import assert_within
from tests.oracles.differences import rate
from tests.tolerances import DIFFERENCE

GRAVITY = np.array([1.0, -2.0, -9.81])


@pytest.mark.parametrize("base", ["floating", "planar"])
@pytest.mark.parametrize("seed", [4, 5, 6])
def test_r31_r32_forces_and_twists_change_as_differences_say(seed, base):
    rng = np.random.default_rng(seed)
    tree = random_tree(rng, 6, base, masses=True)
    for body in tree["bodies"]:
        body["actuated"] = False
    tree_system = own_system(tree)
    system = tree_system.system
    q = system.integrate(tree_system.model_q(random_q(rng, tree)), np.zeros(system.n_v))
    kinematics = system.kinematics(q)
    motion = MotionRates(kinematics, system.column_map)
    rates = MassRates(system, kinematics, motion)
    x = rng.normal(size=system.n_v)
    W = rng.normal(size=(len(motion.J), 6))

    def changing(delta_q):
        moved = system.integrate(q, delta_q)
        J = MotionRates(system.kinematics(moved), system.column_map).J
        force = np.einsum("lai,la->i", J, W)
        gravity = system.gravity_force(moved, GRAVITY)
        return np.concatenate([system.M_u(moved) @ x, gravity, force, (J @ x).ravel()])

    by_q = np.concatenate([
        rates.inertial_force_rates(x), rates.gravity_rates(GRAVITY),
        motion.force_rates(W, 0 * motion.J), motion.twist_rates(x).reshape(-1, system.n_v),
    ])  # fmt: skip
    for k, e in enumerate(np.eye(system.n_v)):
        expected = rate(lambda t, e=e: changing(t * e))
        size = np.abs(expected).max(initial=1.0)
        assert_within(by_q[:, k], expected, DIFFERENCE * size)
