"""System: inertia, gravity and wrenches against formulas, differences and the files' numbers."""

import numpy as np
import pytest

from quasistatic_ref.model.system import Body, System
from tests.model.urdf.urdf_texts import BOX, inertial, joint, link, robot
from tests.tolerances import ROUNDING

CART = robot(
    link("rail", inertial=""),
    link("cart", inertial=inertial("2", ("0.01",) * 3)),
    link("bob", inertial=inertial("3", ("0.01",) * 3, '<origin xyz="0 0 -0.7"/>')),
    joint("slide", "rail", "cart", "prismatic", "1 0 0"),
    joint("swing", "cart", "bob", "revolute", "0 1 0"),
)


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
