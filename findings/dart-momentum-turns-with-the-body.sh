#!/usr/bin/env bash
# dartpy 6.20.0: the momentum of a bar that flies straight on at 1 m/s and spins, without gravity or any contact, from
# BodyNode.getLinearMomentum and getAngularMomentum, with and without a pivot; and of two equal bars that fly towards each other.
# Expected: constants in the axes of the world, like getCOMLinearVelocity and getAngularVelocity, which are so unless other axes are
# asked for; and 0 for the sum of the two. What comes: vectors in the axes of each body, so that the momentum of the free
# flight turns about with it, the pivot is a point of the body, and that of the two bars is that of one at twice the mass.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet dartpy==6.20.0 numpy==2.3.5

"$folder/venv/bin/python" - << 'PYTHON'
import dartpy
import numpy as np

MASS = 2.0
MOMENTS = np.diag([0.1, 0.2, 0.3])
PIVOT = np.array([0.0, 1.0, 0.0])


def bar(world, turn, spin, velocity, place):
    """A free bar turned about z, with its spin and velocity in the world's axes."""
    skeleton = dartpy.dynamics.Skeleton()
    joint, body = skeleton.createFreeJointAndBodyNodePair()
    body.setInertia(dartpy.dynamics.Inertia(MASS, [0.0, 0.0, 0.0], MOMENTS))
    world.addSkeleton(skeleton)
    skeleton.setPositions([0.0, 0.0, turn, *place])
    joint.setLinearVelocity(velocity)
    joint.setAngularVelocity(spin)
    return body


world = dartpy.simulation.World()
world.setGravity([0.0, 0.0, 0.0])
world.setTimeStep(1e-3)
body = bar(world, 0.0, [0.0, 0.0, np.pi], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0])
for quarter in range(5):
    rotation = body.getWorldTransform().rotation()
    linear = MASS * body.getCOMLinearVelocity()
    angular = rotation @ MOMENTS @ rotation.T @ body.getAngularVelocity()
    about = angular + np.cross(body.getCOM() - PIVOT, linear)
    turned = angular + np.cross(body.getCOM() - body.getWorldTransform().multiply(PIVOT), linear)
    said = body.getAngularMomentum(PIVOT)
    print(
        f"after {world.getTime():.1f} s: {body.getLinearMomentum().round(3) + 0.0} kg m/s, true {linear.round(3) + 0.0}; about "
        f"{PIVOT} m {said[2]:.3f} kg m^2/s, true {about[2]:.3f}"
    )
    assert np.allclose(linear, [MASS, 0.0, 0.0], atol=1e-9)
    assert np.isclose(about[2], MOMENTS[2, 2] * np.pi + MASS)
    assert np.allclose(body.getLinearMomentum(), rotation.T @ linear, atol=1e-9)
    assert np.allclose(said, rotation.T @ turned, atol=1e-9)
    if quarter == 2:
        assert np.allclose(body.getLinearMomentum(), [-MASS, 0.0, 0.0], atol=1e-6)
        assert np.isclose(said[2], MOMENTS[2, 2] * np.pi - MASS, atol=1e-6)
    for _ in range(500):
        world.step()

world = dartpy.simulation.World()
pair = [bar(world, turn, np.zeros(3), [speed, 0, 0], [-speed, 0, 0]) for turn, speed in ((0.0, 1.0), (np.pi, -1.0))]
said = sum(each.getLinearMomentum() for each in pair)
true = sum(MASS * each.getCOMLinearVelocity() for each in pair)
print(f"two bars face to face: {said.round(3)} kg m/s, true {true.round(3) + 0.0}")
assert np.allclose(true, 0.0, atol=1e-9)
assert np.allclose(said, [2 * MASS, 0.0, 0.0], atol=1e-9)
PYTHON
