"""System: inertia, gravity and wrenches against formulas, differences and the files' numbers."""

import numpy as np
import pytest

from quasistatic_ref import Body, System
from quasistatic_ref.model import workspace
from quasistatic_ref.model.angles import cos_sin
from tests.model.urdf.urdf_texts import BOX, inertial, joint, link, mimic, robot
from tests.tolerances import ROUNDING

CART = robot(
    link("rail", inertial=""),
    link("cart", inertial=inertial("2", ("0.01",) * 3)),
    link("bob", inertial=inertial("3", ("0.01",) * 3, '<origin xyz="0 0 -0.7"/>')),
    joint("slide", "rail", "cart", "prismatic", "1 0 0"),
    joint("swing", "cart", "bob", "revolute", "0 1 0"),
)


def test_m_u_of_a_free_body_beside_actuated_joints_is_the_same_everywhere():
    system = System([Body("crane", CART, actuated="all"), Body("box", BOX, "floating")])
    assert system.constant_mass_matrix
    assert system.M_u(system.integrate(system.q_start, np.ones(8))) is system.M_u(system.q_start)


def test_m_u_of_a_free_body_beside_free_joints_is_the_one_that_it_has_alone():
    alone = System([Body("box", BOX, "floating")]).mass_blocks[0]
    system = System([Body("crane", CART), Body("box", BOX, "floating")])
    for q in (system.q_start, system.integrate(system.q_start, np.full(8, 0.3))):
        M_u = system.M_u(q)
        assert M_u[2:, 2:].tobytes() == alone.tobytes()
        assert (M_u[:2, 2:] == 0).all()
        # The bob swings below the cart, which moves it, too: M_01 = -m_b l cos(a).
        assert M_u[0, 1] == pytest.approx(-3.0 * 0.7 * np.cos(q[1]), abs=10 * ROUNDING)


def test_m_u_of_one_joint_that_moves_its_links_alone_is_one_array():
    # Of the bob with an actuated cart: I + m_b l^2.
    system = System([Body("crane", CART, actuated=["slide"])])
    M_u = system.M_u(system.q_start)
    assert M_u == pytest.approx(0.01 + 3.0 * 0.7**2, rel=ROUNDING)
    assert system.M_u(np.array([0.2, 1.0])) is M_u


def test_m_u_of_two_tilted_free_bodies_is_as_their_files_say_to_the_last_bit():
    alone = System([Body("box", BOX, "floating")]).mass_blocks[0]
    tilted = [Body(name, BOX, "floating", rpy=(0.3, 0.4, 0.5)) for name in ("one", "other")]
    system = System([Body("crane", CART), *tilted])
    M_u = system.M_u(system.q_start)
    for block in (slice(2, 8), slice(8, 14)):
        assert M_u[block, block].tobytes() == alone.tobytes()


def test_m_u_of_a_joint_follows_what_an_actuated_joint_moves_below_its_mimic():
    # A wheel, and a geared one (0.5 turns for one) along whose spoke a bead of 3 kg moves. With the
    # bead at the distance x: M = I_wheel + 0.5^2 (I_geared + I_bead + m x^2).
    wheels = robot(
        link("rail", inertial=""),
        *(link(name, inertial=inertial("2", ("0.01",) * 3)) for name in ("wheel", "geared")),
        link("bead", inertial=inertial("3", ("0.01",) * 3)),
        joint("turn", "rail", "wheel"),
        joint("turn_geared", "rail", "geared", more=mimic("turn", 0.5)),
        joint("spoke", "geared", "bead", "prismatic", "1 0 0"),
    )
    for others in ((), (Body("crane", CART),)):
        system = System([*others, Body("wheels", wheels, actuated=["spoke"])])
        for x in (0.2, 0.6):
            q = system.q_start.copy()
            q[0] = x
            expected = 0.01 + 0.5**2 * (0.01 + 0.01 + 3.0 * x**2)
            assert system.M_u(q)[-1, -1] == pytest.approx(expected, rel=ROUNDING)


def test_sines_are_computed_once_at_a_configuration(monkeypatch):
    angles = []

    def counted(angle):
        angles.append(angle)
        return cos_sin(angle)

    system = System([Body("crane", CART)])
    monkeypatch.setattr(workspace, "cos_sin", counted)
    q = np.array([0.2, 1.0])
    system.kinematics(q)
    system.gravity_force(q, [0.0, 0.0, -9.81])
    assert angles == [1.0]
