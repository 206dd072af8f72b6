#!/usr/bin/env bash
# pybullet 3.2.7: a ball of 0.3 kg on a plane, both with lateralFriction 0.7 and spinningFriction 0.01, under a torque about
# the normal of half of what spinning friction bears.
# Expected: the ball rests, whether the friction cone is on (enableConeFriction=1, the default) or friction is a pyramid (0).
# What comes: with the pyramid the ball spins as if it had no spinning friction at all.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pybullet==3.2.7 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import pybullet as p

MASS, RADIUS, LATERAL, SPINNING = 0.3, 0.05, 0.7, 0.01
LIMIT = 2 * SPINNING * LATERAL * MASS * 9.81  # the two bodies' products are added


def spin(cone):
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    p.setPhysicsEngineParameter(fixedTimeStep=1e-3, enableConeFriction=cone)
    plane = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    ball = p.createMultiBody(MASS, p.createCollisionShape(p.GEOM_SPHERE, radius=RADIUS), basePosition=[0, 0, RADIUS])
    for body in plane, ball:
        p.changeDynamics(body, -1, lateralFriction=LATERAL, spinningFriction=SPINNING, angularDamping=0)
    for _ in range(500):
        p.applyExternalTorque(ball, -1, [0, 0, LIMIT / 2], p.WORLD_FRAME)
        p.stepSimulation()
    rate = p.getBaseVelocity(ball)[1][2]
    p.disconnect()
    return rate


free = LIMIT / 2 / (0.4 * MASS * RADIUS**2) * 0.5
rates = {cone: spin(cone) for cone in (1, 0)}
print(f"rate after 0.5 s [rad/s]: friction cone {rates[1]:.3f}, pyramid {rates[0]:.3f}; without friction {free:.3f}")
assert abs(rates[1]) < 1e-6
assert abs(rates[0] - free) < 0.01 * free
PYTHON
