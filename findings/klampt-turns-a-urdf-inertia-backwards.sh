#!/usr/bin/env bash
# Klampt 0.10.1.post1: a link in URDF whose inertial origin is turned (rpy) against the link. The inertia is that of a plate
# of 1 x 2 m, 2 kg, about its own axes, and the hinge turns about x, y or z of the link through the centre of mass.
# Expected: R I R^T in the link's axes, since the origin is the pose of the inertial frame in the link's.
# What comes: R^T I R. A turn about one axis looks right on the diagonal and has the wrong sign beside it; a turn about two
# gives the hinge an inertia that is off by a fifth; the same link written without a turn, by I rotated, is right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet klampt==0.10.1.post1 numpy==2.4.6 scipy==1.17.1
cd "$folder"

venv/bin/python - << 'PYTHON' 2>&1 | grep --invert-match -e URDFParser -e LoadRobot
import klampt
import numpy as np
from scipy.spatial.transform import Rotation

OWN = 2 / 12 * np.diag([4.0, 1.0, 5.0])


def read(rpy, inertia):
    """Inertia about the link's axes, and of hinges about x, y and z."""
    entries = " ".join(f'i{"xyz"[i]}{"xyz"[j]}="{inertia[i, j]:.12f}"' for i in range(3) for j in range(i, 3))
    hinges = []
    for axis in ("1 0 0", "0 1 0", "0 0 1"):
        with open("plate.urdf", "w", encoding="ascii") as file:
            file.write(
                '<robot name="r"><link name="base"/><joint name="hinge" type="revolute"><parent link="base"/>'
                f'<child link="plate"/><origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="{axis}"/>'
                '<limit lower="-2" upper="2" effort="9" velocity="9"/></joint><link name="plate"><inertial>'
                f'<origin xyz="0 0 0" rpy="{" ".join(map(str, rpy))}"/><mass value="2"/><inertia {entries}/>'
                "</inertial></link></robot>"
            )
        world = klampt.WorldModel()
        assert world.loadElement("plate.urdf") >= 0
        link = world.robot(0).link("plate")
        hinges.append(world.robot(0).getMassMatrix()[link.getIndex()][link.getIndex()])
    return np.reshape(link.getMass().getInertia(), (3, 3)), np.array(hinges)


for rpy in ((0, 0, 0), (0.5, 0, 0), (0, 0, 0.5), (0.9, 0, 0.5), (0.5, 0.9, 0.5)):
    R = Rotation.from_euler("xyz", rpy).as_matrix()
    given, hinges = read(rpy, OWN)
    print(f"rpy {rpy}: hinges {hinges.round(4)}, true {np.diag(R @ OWN @ R.T).round(4)}; iyz {given[1, 2]:+.4f},", end=" ")
    print(f"true {(R @ OWN @ R.T)[1, 2]:+.4f}")
    assert np.allclose(given, R.T @ OWN @ R, atol=1e-6)
    assert np.allclose(hinges, np.diag(R.T @ OWN @ R), atol=1e-6)
    turned, hinges_turned = read((0, 0, 0), R @ OWN @ R.T)
    assert np.allclose(turned, R @ OWN @ R.T, atol=1e-6)
    assert np.allclose(hinges_turned, np.diag(R @ OWN @ R.T), atol=1e-6)
    if np.count_nonzero(rpy) > 1:
        assert np.abs(hinges - hinges_turned).max() > 0.05
PYTHON
