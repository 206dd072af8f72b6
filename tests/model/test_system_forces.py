"""System: inertia as files have it, beside joints, and changes of actuated coordinates."""

import numpy as np

from quasistatic_ref import Body, System
from tests.closeness import assert_within
from tests.files.urdf.urdf_texts import BOX, inertial, joint, link, robot
from tests.tolerances import ROUNDING

CART = robot(
    link("rail", inertial=""),
    link("cart", inertial=inertial("2", ("0.01",) * 3)),
    link("bob", inertial=inertial("3", ("0.01",) * 3, '<origin xyz="0 0 -0.7"/>')),
    joint("slide", "rail", "cart", "prismatic", "1 0 0"),
    joint("swing", "cart", "bob", "revolute", "0 1 0"),
)


def test_m_u_of_free_bodies_beside_free_joints_is_as_their_files_say_to_the_last_bit():
    alone = System([Body("box", BOX, "floating")]).mass_blocks[0]
    tilted = [Body(name, BOX, "floating", rpy=(0.3, 0.4, 0.5)) for name in ("one", "other")]
    system = System([Body("crane", CART), *tilted])
    for q in (system.q_start, system.integrate(system.q_start, np.full(14, 0.3))):
        M_u = system.M_u(q)
        for block in (slice(2, 8), slice(8, 14)):
            assert M_u[block, block].tobytes() == alone.tobytes()
        assert (M_u[:2, 2:] == 0).all()
        # The bob swings below the cart, which moves it, too: M_01 = -m_b l cos(a).
        assert_within(M_u[0, 1], -3.0 * 0.7 * np.cos(q[1]), 10 * ROUNDING)


def test_actuated_coordinates_change_whatever_comes_after_them():
    system = System([Body("crane", CART, actuated=["slide"])])
    change = system.actuated_difference(np.array([0.25, 1.0]), np.array([0.75]))
    assert change.tolist() == [0.75 - 0.25]
