#!/usr/bin/env bash
# pinocchio 4.1.0: the derivative by q of a body's acceleration, from getJointAccelerationDerivatives, in LOCAL and in WORLD,
# for a ball joint or a free flyer: first at the root, then at the tip of an arm that turns.
# Expected: the differences of getAcceleration, for both frames. What comes: at the root they agree to 1e-7; on the arm LOCAL
# still does, but WORLD is off by as much as its own size, in the columns of the joint of several degrees of freedom.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pin==4.1.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import pinocchio as pin

STEP = 1e-6


def errors(frame, *joints):
    """Largest error of the columns of each joint, as part of the largest true entry."""
    model = pin.Model()
    for k, joint in enumerate(joints):
        place = pin.SE3(pin.rpy.rpyToMatrix(0.3, -0.5, 0.7), np.array([0.2, 0.4, -0.1]))
        model.addJoint(k, joint, place, f"joint{k}")
    data = model.createData()
    rng = np.random.default_rng(0)
    q = pin.integrate(model, pin.neutral(model), rng.normal(size=model.nv))
    v, a = rng.normal(size=(2, model.nv))
    last = model.njoints - 1

    def acceleration(change):
        pin.forwardKinematics(model, data, pin.integrate(model, q, change), v, a)
        return pin.getAcceleration(model, data, last, frame).vector

    true = np.array([(acceleration(e) - acceleration(-e)) / (2 * STEP) for e in STEP * np.eye(model.nv)]).T
    pin.computeForwardKinematicsDerivatives(model, data, q, v, a)
    given = pin.getJointAccelerationDerivatives(model, data, last, frame)[1]
    wrong = np.abs(given - true) / np.abs(true).max()
    return [wrong[:, i : i + n].max() for i, n in zip(model.idx_vs[1:], model.nvs[1:], strict=True)]


for kind in (pin.JointModelSpherical, pin.JointModelFreeFlyer, pin.JointModelPlanar):
    for name, frame in (("LOCAL", pin.LOCAL), ("WORLD", pin.WORLD)):
        root = errors(frame, kind(), pin.JointModelRY())
        arm = errors(frame, pin.JointModelRZ(), kind())
        print(f"{kind().shortname():21} {name}: at the root {max(root):.1e}; on an arm {arm[0]:.1e} and {arm[1]:.1e}")
        assert max(root) < 1e-6 > arm[0]
        assert arm[1] > 0.1 if frame == pin.WORLD else arm[1] < 1e-6
PYTHON
