#!/usr/bin/env bash
# Klampt 0.10.1.post1: a cube, a plank and a door of 6 kg from model.create.primitives, by box and by bbox, whose inertia is said to be
# determined automatically; beside the inertia that Mass.estimate gives for the same geometry, and what a simulated second of a
# torque about the height does to the spin.
# Expected: m (width^2 + depth^2) / 12 about the height. What comes: m (width^2 + height^2) / 12, as about the depth. The cube does
# not show it; a plank that lies flat spins up five times too fast, and its moments break the triangle inequality, as
# those of no body do. The mass, the centre of mass and Mass.estimate are right.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet klampt==0.10.1.post1 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import klampt
import numpy as np
from klampt.model.create import primitives

MASS = 6.0
TORQUE = 0.1


def diagonal(mass):
    """Moments of inertia, from either of the two forms that Klampt has for them."""
    return np.diag(np.reshape(mass.getInertia(), (3, 3)))


def spin(box):
    """Speed about the height after a second of the torque, without gravity."""
    simulator = klampt.Simulator(box[0])
    simulator.setGravity((0.0, 0.0, 0.0))
    body = simulator.body(box[1])
    for _ in range(100):
        body.applyWrench((0.0, 0.0, 0.0), (0.0, 0.0, TORQUE))
        simulator.simulate(0.01)
    return body.getVelocity()[0][2]


for name, size in (("cube", (1.0, 1.0, 1.0)), ("plank", (1.0, 2.0, 0.1)), ("door", (1.0, 0.05, 2.0))):
    width, depth, height = size
    due = MASS / 12 * np.array([depth**2 + height**2, width**2 + height**2, width**2 + depth**2])
    for maker, arguments in ((primitives.box, size), (primitives.bbox, ([0.0, 0.0, 0.0], size))):
        world = klampt.WorldModel()
        box = maker(*arguments, world=world, mass=MASS)
        moments = diagonal(box.getMass())
        estimate = klampt.Mass()
        estimate.estimate(box.geometry(), MASS, 0.0)
        speed = spin((world, box))
        print(
            f"{name} of {size} m: {moments.round(4)} kg m^2, true {due.round(4)}, Mass.estimate {diagonal(estimate).round(4)}; "
            f"spins at {speed:.4f} rad/s, due {TORQUE / due[2]:.4f}"
        )
        assert np.allclose(diagonal(estimate), due, rtol=1e-6)
        assert np.allclose(moments[:2], due[:2])
        assert np.isclose(moments[2], moments[1])
        assert np.isclose(speed, TORQUE / moments[2], rtol=0.03)
    if name == "plank":
        assert speed > 4.8 * TORQUE / due[2]
        assert moments.max() > 1.9 * (moments.sum() - moments.max())
PYTHON
