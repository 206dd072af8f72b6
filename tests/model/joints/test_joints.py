"""Every kind of joint and of base: as it is read, its q (+) delta_q is pinocchio's."""

import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref import Body, System
from quasistatic_ref.model.joints import BASES, JOINTS
from tests.closeness import assert_within
from tests.files.urdf.urdf_texts import joint, link, robot

AXIS = np.array([0.6, 0.0, 0.8])
ROUNDING_OF_PINOCCHIO = 1e-12
KINDS = [*(("base", kind) for kind in BASES), *(("joint", kind) for kind in JOINTS)]


@pytest.mark.parametrize(("of", "kind"), KINDS)
def test_sums_changes_and_poses_are_those_of_pinocchio(of, kind):
    if of == "base":
        body = Body("r", robot(link("arm")), kind)
    else:
        turn = joint("turn", "foot", "arm", kind, "0.6 0 0.8")
        body = Body("r", robot(link("foot"), link("arm"), turn))
    system = System([body])
    model = pin.Model()
    made = BASES[kind] if of == "base" else JOINTS[kind]
    model.addJoint(0, made.model(AXIS), pin.SE3.Identity(), "turn")
    data = model.createData()
    assert (system.n_q, system.n_v) == (model.nq, model.nv)
    rng = np.random.default_rng(0)
    for _ in range(50):
        q = pin.integrate(model, pin.neutral(model), rng.uniform(-1, 1, model.nv))
        delta_q = rng.uniform(-1, 1, model.nv)
        q_next = system.integrate(q, delta_q)
        assert_within(q_next, pin.integrate(model, q, delta_q), ROUNDING_OF_PINOCCHIO)
        change = system.difference(q, q_next)
        assert_within(change, pin.difference(model, q, q_next), ROUNDING_OF_PINOCCHIO)
        assert_within(change, delta_q, ROUNDING_OF_PINOCCHIO)
        pin.forwardKinematics(model, data, q_next)
        R, t = system.pose(q_next, "r/arm")
        assert_within(R, data.oMi[1].rotation, ROUNDING_OF_PINOCCHIO)
        assert_within(t, data.oMi[1].translation, ROUNDING_OF_PINOCCHIO)
