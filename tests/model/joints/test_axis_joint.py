"""Joints of one coordinate: what inherits one of them is another kind."""

import math
from dataclasses import replace

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.model.joints import JOINTS, AxisJoint, Revolute
from quasistatic_ref.numbers.angles import cos_sin
from tests.files.urdf.urdf_texts import joint, link, mimic, robot

ARM = robot(link("base"), link("arm"), joint("turn", "base", "arm"))


def wrapping(parent):
    """A class of joints whose angle stays between -pi and pi."""

    class Wrapping(parent):
        def integrated(self, q, delta_q):
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


@pytest.mark.parametrize("followed", [False, True])
def test_sines_are_correctly_rounded_but_of_a_joint_that_another_mimics(followed):
    """Those are pinocchio's, of the C library, as docs/exactness.md says: within one ulp."""
    more = mimic("turn") if followed else ""
    text = robot(
        link("base"), link("arm"), link("hand"),
        joint("turn", "base", "arm"), joint("grip", "arm", "hand", more=more),
    )  # fmt: skip
    system = qr.System([qr.Body("r", text, actuated="all")])
    arm = system.link("r/arm")
    off = 0
    for angle in np.random.default_rng(0).uniform(-3, 3, 2000):
        q = np.zeros(system.n_q)
        q[0] = angle
        of_link = system.at(q).kinematics.R[arm, :2, 0]
        rounded = np.array(cos_sin(angle))
        off += not (of_link == rounded).all()
        assert (np.abs(of_link - rounded) <= np.spacing(np.abs(rounded))).all()
    assert (off > 0) == followed
