#!/usr/bin/env bash
# pinocchio 4.1.0: a wrist of three hinges (z, y, x), once as three joints, once as one JointModelComposite of the same three,
# once as JointModelSphericalZYX; the same q, v and a mean the same motion.
# Expected: the same from every algorithm. rnea, crba, aba and the bias forces are the same indeed. What comes otherwise:
# the Coriolis matrix times v is not the Coriolis force (so Mdot - 2 C is not skew), and the derivatives of rnea by q and v,
# the rates of Jacobians and of the centroidal momentum leave out that the later axes turn; nothing warns.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pin==4.1.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import pinocchio as pin

hinges = pin.JointModelRZ(), pin.JointModelRY(), pin.JointModelRX()
composite = pin.JointModelComposite(3)
for hinge in hinges:
    composite.addJoint(hinge)
body = pin.Inertia(2.0, np.array([0.1, 0.2, 0.3]), np.diag([0.3, 0.4, 0.5]))
q, v, a = np.array([[0.4, -0.7, 0.9], [1.0, -2.0, 1.5], [0.5, 0.3, -0.8]])


def compute(*joints):
    model = pin.Model()
    for k, joint in enumerate(joints):
        model.addJoint(k, joint, pin.SE3.Identity(), f"joint{k}")
    last = model.njoints - 1
    model.appendBodyToJoint(last, body, pin.SE3.Identity())
    data = model.createData()
    torque = pin.rnea(model, data, q, v, a).copy()
    mass = pin.crba(model, data, q).copy()
    force = pin.nonLinearEffects(model, data, q, v) - pin.computeGeneralizedGravity(model, data, q)
    coriolis = pin.computeCoriolisMatrix(model, data, q, v) @ v
    by_q, by_v, _ = (part.copy() for part in pin.computeRNEADerivatives(model, data, q, v, a))
    pin.computeJointJacobiansTimeVariation(model, data, q, v)
    rate = pin.getJointJacobianTimeVariation(model, data, last, pin.WORLD) @ v
    momentum = pin.dccrba(model, data, q, v) @ v
    same = {"torque": torque, "mass": np.triu(mass), "force": force}
    return same, {"C v": coriolis, "by q": by_q, "by v": by_v, "rate of J": rate, "of momentum": momentum}


same, others = compute(*hinges)
assert np.allclose(others["C v"], same["force"])
for joint in (composite, pin.JointModelSphericalZYX()):
    same_here, here = compute(joint)
    for name, value in same.items():
        assert np.allclose(value, same_here[name]), name
    for name, value in others.items():
        wrong = np.abs(here[name] - value).max() / np.abs(value).max()
        print(f"{joint.shortname():24} {name:11} differs from three hinges by {100 * wrong:.0f} %")
        assert wrong > 0.1, name
    print(f"  Coriolis force {same['force'].round(3)}, matrix times v {here['C v'].round(3)}")
PYTHON
