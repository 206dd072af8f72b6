"""System: inertia, gravity and wrenches against formulas, differences and the files' numbers."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.model.system import Body, System
from tests.model.urdf.urdf_texts import BOX, inertial, joint, link, robot, written
from tests.tolerances import ROUNDING

GRAVITY = np.array([1.0, -2.0, -9.81])
PENDULUM = robot(
    link("pivot", inertial=""),
    '<link name="bob"><inertial><origin xyz="0 0 -0.7"/><mass value="3"/>'
    '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>',
    joint("swing", "pivot", "bob", "continuous", "0 1 0"),
)


def cross_matrix(c: np.ndarray) -> np.ndarray:
    return np.cross(c, np.eye(3)).T


def test_the_mass_matrix_of_a_free_box_is_the_formula(tmp_path: Path) -> None:
    system = System([Body("box", written(tmp_path, BOX), "floating")])
    m, C = 1.5, cross_matrix(np.array([0.01, -0.02, 0.03]))
    I_c = np.array([[0.02, 0.001, 0], [0.001, 0.03, 0], [0, 0, 0.04]])
    expected = np.block([[m * np.eye(3), -m * C], [m * C, I_c - m * C @ C]])
    assert np.abs(system.M_u(system.q_start) - expected).max() < ROUNDING


@pytest.mark.parametrize("angle", [0.0, 0.3, np.pi / 2, -2.5])
def test_gravity_turns_a_pendulum_by_m_g_l_sin(tmp_path: Path, angle: float) -> None:
    body = Body("p", written(tmp_path, PENDULUM), actuated="all", positions={"swing": angle})
    system = System([body])
    force = system.gravity_force(system.q_start, [0, 0, -9.81])
    assert force == pytest.approx([-3 * 9.81 * 0.7 * np.sin(angle)], abs=20 * ROUNDING)


def test_gravity_on_a_free_box_is_its_weight_in_the_body_frame(tmp_path: Path) -> None:
    system = System([Body("box", written(tmp_path, BOX), "floating", rpy=(0.3, 0.4, 0.5))])
    weight = 1.5 * Rotation.from_euler("xyz", [0.3, 0.4, 0.5]).inv().apply(GRAVITY)
    moment = np.cross([0.01, -0.02, 0.03], weight)
    force = system.gravity_force(system.q_start, GRAVITY)
    assert force == pytest.approx(np.r_[weight, moment], abs=20 * ROUNDING)


def test_gravity_of_another_call_leaves_no_trace(scene: System, q: np.ndarray) -> None:
    one, kinematics = scene.gravity_force(q, GRAVITY), scene.kinematics(q)
    scene.gravity_force(scene.q_start, [3, 2, 1])
    scene.M_u(scene.q_start)
    assert np.array_equal(scene.gravity_force(q, GRAVITY), one)
    assert np.array_equal(scene.kinematics(q).J, kinematics.J)
    assert not scene.gravity_force(q, np.zeros(3)).any()


def test_weight_at_the_centre_of_mass_is_gravity(tmp_path: Path) -> None:
    welded = robot(
        link("a"), link("b"), joint("w", "a", "b", "fixed", more='<origin xyz="1 2 3"/>')
    )
    system = System([Body("a", written(tmp_path, welded), "floating", rpy=(1, 2, 3))])
    q, weight = system.q_start, system.mass("a") * GRAVITY
    force = system.centre_of_mass_force(q, "a", weight, np.zeros(3))
    assert force == pytest.approx(system.gravity_force(q, GRAVITY), abs=100 * ROUNDING)


CART = robot(
    link("rail", inertial=""),
    link("cart", inertial=inertial("2", ("0.01",) * 3)),
    link("bob", inertial=inertial("3", ("0.01",) * 3, '<origin xyz="0 0 -0.7"/>')),
    joint("slide", "rail", "cart", "prismatic", "1 0 0"),
    joint("swing", "cart", "bob", "revolute", "0 1 0"),
)


def test_the_mass_matrix_of_a_cart_and_its_pendulum_follows_the_angle() -> None:
    # The bob is at x = s - l sin(a): M = [m + m_b, -m_b l cos(a); ., I + m_b l^2].
    m, m_b, length, moment = 2.0, 3.0, 0.7, 0.01
    system = System([Body("crane", CART)])
    assert not system.constant_mass_matrix
    for angle in (0.0, 1.0, 2.0):
        q = np.array([0.3, angle])
        both = -m_b * length * np.cos(angle)
        expected = [[m + m_b, both], [both, moment + m_b * length**2]]
        np.testing.assert_allclose(system.M_u(q), expected, rtol=0, atol=10 * ROUNDING)


def test_m_u_of_a_free_body_beside_actuated_joints_is_the_same_everywhere() -> None:
    system = System([Body("crane", CART, actuated="all"), Body("box", BOX, "floating")])
    assert system.constant_mass_matrix
    assert system.M_u(system.integrate(system.q_start, np.ones(8))) is system.M_u(system.q_start)


def test_m_u_of_a_free_body_beside_free_joints_is_the_one_that_it_has_alone() -> None:
    alone = System([Body("box", BOX, "floating")]).mass_blocks[0]
    system = System([Body("crane", CART), Body("box", BOX, "floating")])
    for q in (system.q_start, system.integrate(system.q_start, np.full(8, 0.3))):
        M_u = system.M_u(q)
        assert M_u[2:, 2:].tobytes() == alone.tobytes()
        assert (M_u[:2, 2:] == 0).all()
        # The bob swings below the cart, which moves it, too: M_01 = -m_b l cos(a).
        assert M_u[0, 1] == pytest.approx(-3.0 * 0.7 * np.cos(q[1]), abs=10 * ROUNDING)


def test_m_u_of_one_joint_that_moves_its_links_alone_is_one_array() -> None:
    # Of the bob with an actuated cart: I + m_b l^2.
    system = System([Body("crane", CART, actuated=["slide"])])
    M_u = system.M_u(system.q_start)
    assert M_u == pytest.approx(0.01 + 3.0 * 0.7**2, rel=ROUNDING)
    assert system.M_u(np.array([0.2, 1.0])) is M_u
