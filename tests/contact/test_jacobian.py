"""Tangents are a fixed function of the normal, and J is formed by each contact's own columns."""

import itertools

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.contact.jacobian import ContactGeometry, columns_at, tangents
from quasistatic_ref.contact.pairs import ContactLayout
from quasistatic_ref.step.contacts import spread
from tests.closeness import assert_within
from tests.made import bits
from tests.model.mechanisms import WHEELS

TIED = """<mujoco><worldbody><body name="a"><joint name="one" type="slide" axis="1 0 0"/>
<geom size=".1"/><body name="b"><joint name="two" axis="0 1 0"/><geom size=".1" pos="1 0 0"/></body>
</body><body name="c" pos="3 0 0"><freejoint/><geom size=".1"/></body></worldbody>
<equality><joint joint1="two" joint2="one" polycoef="0 .5 0 0 0"/></equality></mujoco>"""


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


def system_of(kind):
    """A system with several bodies."""
    if kind == "mimic":  # before the joint that it mimics in the paper's order, or after it
        wheels = [qr.Body(f"w{i}", WHEELS, "planar", own) for i, own in enumerate(((), ("open",)))]
        return qr.System(wheels)
    if kind == "tied":
        return qr.mujoco_scenario(mujoco.MjModel.from_xml_string(TIED)).system
    return qr.load_scenario(kind).system


@pytest.mark.parametrize("kind", ["bunny_grasp", "stack", "mimic", "tied"])
def test_own_columns_are_those_that_can_move_a_contact_and_have_the_bits_of_all(kind, rng):
    system = system_of(kind)
    q = system.integrate(system.q_start, 0.1 * rng.normal(size=system.n_v))
    kinematics = system.kinematics(q)
    column_map = kinematics.column_map
    alpha, beta = np.array([*itertools.permutations(range(len(system.links)), 2)]).T
    n_c = len(alpha)
    zeros = np.zeros(n_c)
    layout = ContactLayout(("p",) * n_c, alpha, beta, zeros, zeros, np.full(n_c, 6))
    geometry = ContactGeometry(layout, column_map)
    r = rng.normal(size=(2, n_c, 3))
    n = rng.normal(size=(n_c, 3))
    J = spread(geometry.jacobian(kinematics.columns, *r, n), geometry.column, system.n_v)
    moves = column_map.moves[np.stack([alpha, beta])]
    of_alpha, of_beta = moves * columns_at(kinematics.columns, r, n)
    assert bits(J) == bits(column_map.of_coordinates(of_beta - of_alpha) + 0.0)
    can_move = column_map.of_coordinates(moves.max(axis=0))[:, 0] != 0
    for own, can in zip(geometry.column, can_move, strict=True):
        assert own[own < system.n_v].tolist() == np.flatnonzero(can).tolist()
