"""Tangents are a fixed function of the normal, and J is formed in blocks."""

import numpy as np

from quasistatic_ref import load_scenario
from quasistatic_ref.contact import jacobian
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.formats.plain import bits
from tests.closeness import assert_within


def test_d1_is_the_projection_of_the_world_axis_farthest_from_n_and_d2_is_n_x_d1(rng):
    """Of any normal, and of one along an axis: of axes as far from n the first is taken."""
    for n in [*rng.normal(size=(50, 3)), *np.eye(3), *(0.0 - np.eye(3))]:
        n /= np.linalg.norm(n)
        axis = np.eye(3)[min(range(3), key=lambda i: abs(n[i]))]
        d1 = axis - (axis @ n) * n
        d1 /= np.linalg.norm(d1)
        expected = [[d1], [np.cross(n, d1)]]
        found = np.array(tangents(n[None]))
        assert_within(found, expected)
        assert not np.signbit(found[found == 0]).any()


def test_J_of_many_contacts_is_formed_block_by_block_with_the_same_bits(monkeypatch):
    scenario = load_scenario("stack")
    simulator = scenario.simulator()
    kinematics = scenario.system.kinematics(scenario.system.q_start)
    points = simulator.closest_points(kinematics)
    whole = simulator.geometry
    assert len(whole.blocks) == 1
    monkeypatch.setattr(jacobian, "BLOCK", 200)
    few = jacobian.ContactGeometry(whole.layout, whole.column_map)
    assert len(few.blocks) > 1
    assert bits(few.contacts(points, kinematics)) == bits(whole.contacts(points, kinematics))
