"""Joints of one coordinate: what inherits one of them is another kind."""

import math
from dataclasses import replace

import pytest

import quasistatic_ref as qr
from quasistatic_ref.model.joints import JOINTS, AxisJoint, Revolute
from tests.model.urdf.urdf_texts import joint, link, robot

ARM = robot(link("base"), link("arm"), joint("turn", "base", "arm"))


def wrapping(parent):
    """A class of joints whose angle stays between -pi and pi."""

    class Wrapping(parent):
        def moved(self, q, delta_q):
            return [math.remainder(q[0] + delta_q[0], 2 * math.pi)]

        def change(self, q, q_next):
            return [math.remainder(q_next[0] - q[0], 2 * math.pi)]

    return Wrapping


@pytest.mark.parametrize("parent", [AxisJoint, Revolute])
def test_a_sum_of_its_own_is_not_that_of_compiled_code(monkeypatch, parent):
    """The first step of a run, whose q+ is compared, does not reach pi; the last one passes it."""
    monkeypatch.setitem(JOINTS, "revolute", wrapping(parent))
    arm = {
        "urdf": ARM, "positions": {"turn": 3.0}, "actuated": ["turn"], "K_q": {"turn": 40.0},
        "targets": [{"t": 0.0, "turn": 3.0}, {"t": 0.1, "turn": 3.3}],
    }  # fmt: skip
    scenario = qr.load_scenario({"h": 0.01, "steps": 12, "bodies": {"arm": arm}})
    plain = scenario.run()
    fast = replace(scenario, fast=True).run()
    assert plain.q[-1, 0] == pytest.approx(3.3 - 2 * math.pi)
    assert (plain.q == fast.q).all()
