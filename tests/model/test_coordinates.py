"""The paper's order of coordinates against pinocchio's, and the names of the entries of q."""

import numpy as np
import pytest

from quasistatic_ref.model.coordinates import paper_order
from quasistatic_ref.model.joints.axis_joint import Prismatic, Revolute
from quasistatic_ref.model.joints.continuous import Continuous
from quasistatic_ref.model.joints.floating import Floating

PINOCCHIO_S = (
    Revolute("swing", False, slice(0, 1), slice(0, 1)),
    Continuous("spin", True, slice(1, 3), slice(1, 2)),
    Floating("box/base", False, slice(3, 10), slice(2, 8)),
    Prismatic("slide", True, slice(10, 11), slice(8, 9)),
)


def test_actuated_entries_come_first_whatever_the_number_of_axes():
    order = paper_order(PINOCCHIO_S)
    assert [joint.name for joint in order.joints] == ["spin", "slide", "swing", "box/base"]
    of_q = [1, 2, 10, 0, *range(3, 10)]
    of_v = [1, 8, 0, *range(2, 8)]
    assert not order.same
    assert order.paper_q(np.arange(11.0)).tolist() == of_q
    assert order.model_q(np.array(of_q)).tolist() == [*range(11)]
    for axes in ((), (2,), (2, 3)):
        v = np.arange(9) + np.zeros((*axes, 9))
        assert np.array_equal(order.paper_v(v), of_v + np.zeros((*axes, 9)))


@pytest.mark.parametrize(
    ("joint", "positions"),
    [
        (PINOCCHIO_S[0], ["swing [rad]"]),
        (PINOCCHIO_S[1], ["spin.cos [-]", "spin.sin [-]"]),
        (
            PINOCCHIO_S[2],
            [*(f"box.{x} [m]" for x in "xyz"), *(f"box.q{x} [-]" for x in "xyzw")],
        ),
        (PINOCCHIO_S[3], ["slide [m]"]),
    ],
)
def test_entries_of_q_have_names_and_units(joint, positions):
    assert list(joint.positions) == positions
