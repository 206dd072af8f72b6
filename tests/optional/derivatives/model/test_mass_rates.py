"""Rates of the mass matrix and of gravity's force, by differences, on random trees of links."""

import numpy as np
import pytest

from quasistatic_ref import Body, System
from quasistatic_ref.lab.vectors.challenge.random_mechanisms import random_q, random_tree
from quasistatic_ref.lab.vectors.own.system import own_system
from quasistatic_ref.optional.derivatives.model.mass_rates import MassRates
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from tests.closeness import assert_within
from tests.model.urdf.urdf_texts import joint, link, robot
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
    own = own_system(tree)
    system = own.system
    q = system.integrate(own.model_q(random_q(rng, tree)), np.zeros(system.n_v))
    check_rates(rng, system, q)


def test_r31_r32_hold_for_links_on_balls(rng):
    links = [link(name) for name in ("root", "arm", "hand")]
    joints = [
        joint("a", "root", "arm", "ball", "1 0 0"),
        joint("b", "arm", "hand", "ball", "1 0 0"),
    ]
    system = System([Body("robot", robot(*links, *joints), "ball")])
    check_rates(rng, system, system.integrate(system.q_start, rng.normal(size=system.n_v)))


def check_rates(rng, system, q):
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

    found = np.concatenate([
        rates.inertial_force_rates(x), rates.gravity_rates(GRAVITY),
        motion.force_rates(W, 0 * motion.J), motion.twist_rates(x).reshape(-1, system.n_v),
    ])  # fmt: skip
    for k, e in enumerate(np.eye(system.n_v)):
        expected = rate(lambda t, e=e: changing(t * e))
        size = np.abs(expected).max(initial=1.0)
        assert_within(found[:, k], expected, DIFFERENCE * size)
    # By masses both forces are linear, the inertia about the centre staying as it is.
    turns = motion.J[:, 3:]
    R = kinematics.R
    kept = np.einsum("lai,lab,lbj->ij", turns, R @ system.inertias @ R.swapaxes(1, 2), turns)
    of_masses = [rates.by_masses(rates.moved @ x), rates.by_masses(GRAVITY)] @ system.masses
    expected = [(system.M_u(q) - kept) @ x, system.gravity_force(q, GRAVITY)]
    assert_within(of_masses, expected, 1e-12 * np.abs(expected).max())
