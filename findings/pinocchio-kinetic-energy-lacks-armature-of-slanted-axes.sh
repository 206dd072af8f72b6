#!/usr/bin/env bash
# pinocchio 4.1.0: the kinetic energy of a hinge whose motor adds an armature of 2 kg m^2, at 3 rad/s, for eight axes.
# Expected: v M v / 2 with the mass matrix of crba, which holds the armature: 9.045 J whatever way the axis points.
# What comes: so much for the joint types RX and RUBX and for a slide, but 0.045 J for JointModelRevoluteUnaligned (as which
# a URDF's hinge about a slanted axis is read), as for JointModelHelicalUnaligned; energy seems to be lost where nothing is.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pin==4.1.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import pinocchio as pin

ARMATURE, SPEED = 2.0, 3.0
slanted = np.array([1.0, 2.0, 2.0]) / 3
unbounded = pin.JointModelRevoluteUnboundedUnaligned()
unbounded.axis = slanted
joints = {
    "hinge, x": pin.JointModelRX(),
    "endless hinge, x": pin.JointModelRUBX(),
    "endless hinge, slanted": unbounded,
    "slide, slanted": pin.JointModelPrismaticUnaligned(slanted),
    "screw, x": pin.JointModelHX(0.1),
    "hinge, slanted": pin.JointModelRevoluteUnaligned(slanted),
    "hinge, z by name of unaligned": pin.JointModelRevoluteUnaligned(np.array([0.0, 0.0, 1.0])),
    "screw, slanted": pin.JointModelHelicalUnaligned(slanted, 0.1),
}
lacking = set()
for name, joint in joints.items():
    model = pin.Model()
    model.addJoint(0, joint, pin.SE3.Identity(), "joint")
    model.appendBodyToJoint(1, pin.Inertia(1.0, np.zeros(3), 0.01 * np.eye(3)), pin.SE3.Identity())
    model.armature[:] = ARMATURE
    data = model.createData()
    q, v = pin.neutral(model), np.full(model.nv, SPEED)
    due = v @ pin.crba(model, data, q) @ v / 2
    energy = pin.computeKineticEnergy(model, data, q, v)
    print(f"{name:30} kinetic energy {energy:7.3f} J, v M v / 2 {due:7.3f} J")
    if not np.isclose(energy, due):
        lacking.add(name)
        assert np.isclose(due - energy, ARMATURE * SPEED**2 / 2)
assert lacking == {"hinge, slanted", "hinge, z by name of unaligned", "screw, slanted"}
PYTHON
