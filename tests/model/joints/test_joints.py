"""Every kind of joint and of base: its sums and poses are pinocchio's, its inertia is by hand."""

import numpy as np
import pinocchio as pin
import pytest

from quasistatic_ref import Body, System
from quasistatic_ref.model.joints import BASES, JOINTS
from tests.closeness import assert_close, assert_within
from tests.files.urdf.urdf_texts import inertial, joint, link, robot

AXIS = np.array([0.6, 0.0, 0.8])
ROUNDING_OF_PINOCCHIO = 1e-12
KINDS = [*(("base", kind) for kind in BASES), *(("joint", kind) for kind in JOINTS)]
MOMENTS = np.diag([0.02, 0.03, 0.04])
CENTRE = np.array([0.0, 0.05, -0.3])
ARM = link("arm", "", inertial("2", ("0.02", "0.03", "0.04"), '<origin xyz="0 0.05 -0.3"/>'))
GRAVITY = np.array([1.0, -2.0, -9.0])


@pytest.mark.parametrize(("of", "kind"), KINDS)
def test_sums_and_poses_are_those_of_pinocchio_and_inertia_and_weight_are_by_hand(of, kind):
    """A link of 2 kg turns by S_w, its centre moves by S_c: M = 2 S_c'S_c + S_w'I S_w, 2 S_c'g."""
    if of == "base":
        body = Body("r", robot(ARM), kind)
    else:
        turn = joint("turn", "foot", "arm", kind, "3 0 4")
        body = Body("r", robot(link("foot"), ARM, turn))
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
        S_v, S_w = R.T @ np.split(system.kinematics(q_next).J[system.link("r/arm")], 2)
        S_c = S_v + np.cross(S_w, CENTRE, axis=0)
        assert_within(system.M_u(q_next), 2 * S_c.T @ S_c + S_w.T @ MOMENTS @ S_w)
        assert_close(system.gravity_force(q_next, GRAVITY), 2 * S_c.T @ R.T @ GRAVITY)
