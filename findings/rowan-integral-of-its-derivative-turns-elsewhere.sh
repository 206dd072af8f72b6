#!/usr/bin/env bash
# rowan 1.3.2: calculus.derivative and calculus.integrate for one orientation and one angular velocity, as the body turns by steps of
# 1 ms for a second, with a constant velocity and with one whose direction changes; beside SciPy.
# Expected: one motion, since both are documented with the angular velocity on the left of q, that is in the axes of the world:
# dq/dt = v q / 2. What comes: so from integrate; derivative multiplies on the right, and so takes the velocity in the axes of the
# body. An integrator of one's own upon derivative ends up to 70 degrees away from integrate. From the identity, with an axis
# that stays, as in the documented example, no difference shows.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet rowan==1.3.2 numpy==2.4.6 scipy==1.17.1

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import rowan
from scipy.spatial.transform import Rotation

STEPS = 1000
STEP = 1 / STEPS
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])
TURNED = Rotation.from_euler("xyz", [0.3, -0.8, 1.2]).as_quat(scalar_first=True)


def steady(_):
    """Angular velocity that stays."""
    return np.array([0.4, 0.8, -0.6])


def wandering(time):
    """Angular velocity whose direction changes."""
    return np.array([np.cos(2 * time), np.sin(2 * time), 0.5])


def angle(first, second):
    """Angle between two orientations, in degrees."""
    return np.degrees((first * second.inv()).magnitude())


def orientation(q):
    """SciPy's orientation of a quaternion with the scalar first."""
    return Rotation.from_quat(q, scalar_first=True)


for name, start, velocity in (
    ("identity, steady", IDENTITY, steady),
    ("turned, steady", TURNED, steady),
    ("identity, wandering", IDENTITY, wandering),
):
    integrated = derived = start
    world = body = orientation(start)
    for index in range(STEPS):
        v = velocity((index + 0.5) * STEP)
        integrated = rowan.calculus.integrate(integrated, v, STEP)
        derived = rowan.normalize(derived + STEP * rowan.calculus.derivative(derived, v))
        world = Rotation.from_rotvec(v * STEP) * world
        body = body * Rotation.from_rotvec(v * STEP)
    apart = angle(orientation(integrated), orientation(derived))
    print(
        f"{name}: integrate is {angle(orientation(integrated), world):.3f} deg from a velocity in the world and "
        f"{angle(orientation(integrated), body):.1f} from one in the body; derivative {angle(orientation(derived), world):.1f} and "
        f"{angle(orientation(derived), body):.3f}; they are {apart:.1f} deg apart"
    )
    assert angle(orientation(integrated), world) < 1e-6
    assert angle(orientation(derived), body) < 0.01
    assert (apart < 0.01) == (name == "identity, steady")
PYTHON
