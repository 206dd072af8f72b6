"""How bodies' motion, masses, (+) and (-) change with q, against central differences."""

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from quasistatic_ref.optional.derivatives.model.mass_rates import MassRates
from quasistatic_ref.optional.derivatives.model.motion_rates import MotionRates
from quasistatic_ref.optional.derivatives.model.tangent import (
    difference_rates,
    sum_rates,
)
from tests.oracles.differences import rate
from tests.scenes import chain_scene
from tests.tolerances import DIFFERENCE

GRAVITY = np.array([1.0, 2.0, -9.0])


@pytest.fixture(params=["chains", "block_push"])
def at(request, tmp_path):
    """(system, q, rates of motion, rates of masses, a displacement) of a random configuration."""
    scene = request.param
    system = chain_scene(tmp_path) if scene == "chains" else load_scenario(scene, fast=True).system
    rng = np.random.default_rng(2)
    q = system.integrate(system.q_start, 0.3 * rng.normal(size=system.n_v))
    kinematics = system.kinematics(q)
    motion = MotionRates(kinematics, system.motion)
    x = rng.normal(size=system.n_v)
    return system, q, motion, MassRates(system, kinematics, motion), x


def differences(system, q, function):
    """Derivatives of a function of q, in tangent coordinates."""
    return np.stack(
        [
            rate(lambda t, e=e: function(system.integrate(q, t * e)), 1e-4)
            for e in np.eye(system.n_v)
        ],
        axis=-1,
    )


def close(found, expected):
    assert np.abs(found - expected).max() <= DIFFERENCE * max(1.0, np.abs(expected).max())


def jacobian(system, q):
    return MotionRates(system.kinematics(q), system.motion).J


def test_twists_of_links_change_by_brackets_of_columns(at):
    system, q, motion, _, x = at
    close(motion.twist_rates(x), differences(system, q, lambda p: jacobian(system, p) @ x))


def test_forces_of_wrenches_change_with_the_columns(at):
    system, q, motion, _, _ = at
    W = np.random.default_rng(3).normal(size=(len(system.links), 6))
    rates = motion.force_rates(W, np.zeros((*W.shape, system.n_v)))
    expected = differences(system, q, lambda p: np.einsum("lai,la->i", jacobian(system, p), W))
    close(rates, expected)


def test_gravity_changes_with_q_and_with_the_masses(at):
    system, q, _, masses, _ = at
    expected = differences(system, q, lambda p: system.gravity_force(p, GRAVITY))
    close(masses.gravity_rates(GRAVITY), expected)
    force = masses.by_masses(GRAVITY) @ system.masses  # it is linear in them
    close(force, system.gravity_force(q, GRAVITY))


def test_the_mass_matrix_changes_with_q(at):
    system, q, _, masses, x = at
    own = np.concatenate([np.zeros(system.n_a), x[system.n_a :]])
    found = masses.inertial_force_rates(own)[system.n_a :]
    close(found, differences(system, q, lambda p: system.M_u(p) @ x[system.n_a :]))


def test_sum_and_difference_change_with_both_arguments(at):
    system, q, _, _, x = at
    x = 0.5 * x
    there = system.integrate(q, x)
    by_q, by_change = sum_rates(system.joints, x)
    close(by_q, differences(system, q, lambda p: system.difference(there, system.integrate(p, x))))
    moved = [
        rate(lambda t, e=e: system.difference(there, system.integrate(q, x + t * e)), 1e-4)
        for e in np.eye(system.n_v)
    ]
    close(by_change, np.transpose(moved))
    by_q, by_next = difference_rates(system.joints, x)
    close(by_q, differences(system, q, lambda p: system.difference(p, there)))
    close(by_next, differences(system, there, lambda p: system.difference(q, p)))
