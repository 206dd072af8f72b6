"""Bullet, through pybullet. A pair's friction is the product of its bodies' coefficients."""

from importlib.metadata import version
from typing import Any

import numpy as np
import pybullet
from pybullet_utils.bullet_client import BulletClient

from validation.programs.engines.scenes import TIME_STEP, Body, Scene

NAME = f"bullet (pybullet {version('pybullet')})"
NO_TORSION = ""
TO_THE_END = {"solverResidualThreshold": 0.0}
SETTINGS: dict[str, dict[str, Any]] = {
    "friction cone, 50 iterations, to the end": {
        "enableConeFriction": 1, "numSolverIterations": 50, **TO_THE_END,
    },
    "friction pyramid, 50 iterations, to the end": {
        "enableConeFriction": 0, "numSolverIterations": 50, **TO_THE_END,
    },
    "friction cone, 500 iterations, to the end": {
        "enableConeFriction": 1, "numSolverIterations": 500, **TO_THE_END,
    },
    "friction cone, 50 iterations or fewer (default)": {
        "enableConeFriction": 1, "numSolverIterations": 50,
    },
    "friction cone, 500 iterations or fewer": {
        "enableConeFriction": 1, "numSolverIterations": 500,
    },
}  # fmt: skip
NOT_DEFAULT = (
    "To the end: solverResidualThreshold = 0. By default it is 1e-7, and iterations end where the "
    "squared residual is below it. In all settings: no damping (linearDamping, angularDamping, "
    "jointDamping), restitutionVelocityThreshold = 0, deterministicOverlappingPairs = 1, and a "
    "joint's motor is off."
)
COMMON = {
    "fixedTimeStep": TIME_STEP,
    "numSubSteps": 0,
    "deterministicOverlappingPairs": 1,
    "enableSAT": 0,  # GJK and EPA
    "restitutionVelocityThreshold": 0.0,
}
JOINTS = {
    "rail_x": (pybullet.JOINT_PRISMATIC, [1, 0, 0]),
    "hinge_z": (pybullet.JOINT_REVOLUTE, [0, 0, 1]),
}
KINDS = {"sphere": pybullet.GEOM_SPHERE, "box": pybullet.GEOM_BOX}


class Engine:
    """A scene in a Bullet world of its own."""

    def __init__(self, scene: Scene, setting: dict[str, Any]) -> None:
        self.bullet = BulletClient(pybullet.DIRECT)
        self.bullet.setPhysicsEngineParameter(**COMMON, **setting)
        self.bullet.setGravity(0, 0, -scene.gravity)
        # Sliding: the product of both. Spinning: a.spinning * b.sliding + b.spinning * a.sliding.
        sliding = float(np.sqrt(scene.mu_v))
        spinning = scene.mu_omega / (2 * sliding)
        self.friction = {"lateralFriction": sliding, "spinningFriction": spinning}
        if scene.floor:
            plane = self.bullet.createCollisionShape(pybullet.GEOM_PLANE)
            self.bullet.changeDynamics(self.bullet.createMultiBody(0, plane), -1, **self.friction)
        self.links = {body.name: self.added(body) for body in scene.bodies}

    def added(self, body: Body) -> tuple[int, int]:
        """Number of a body and of its link, -1 for its base."""
        solid = self.bullet.createCollisionShapeArray(
            shapeTypes=[KINDS[shape.kind] for shape in body.shapes],
            radii=[shape.size[0] for shape in body.shapes],
            halfExtents=[np.resize(shape.size, 3) / 2 for shape in body.shapes],
            collisionFramePositions=[shape.xyz for shape in body.shapes],
        )
        if body.joint in JOINTS:
            kind, axis = JOINTS[body.joint]
            origin, straight = [0, 0, 0], [0, 0, 0, 1]
            number = self.bullet.createMultiBody(
                0, basePosition=body.xyz, linkMasses=[body.mass],
                linkCollisionShapeIndices=[solid], linkVisualShapeIndices=[-1],
                linkPositions=[origin], linkOrientations=[straight],
                linkInertialFramePositions=[origin], linkInertialFrameOrientations=[straight],
                linkParentIndices=[0], linkJointTypes=[kind], linkJointAxis=[axis],
            )  # fmt: skip
            link = 0
            motor = pybullet.VELOCITY_CONTROL
            self.bullet.setJointMotorControl2(number, link, motor, force=0)
        else:
            mass = 0 if body.joint == "fixed" else body.mass
            number = self.bullet.createMultiBody(mass, solid, basePosition=body.xyz)
            link = -1
        self.bullet.changeDynamics(
            number, link, **self.friction, rollingFriction=0.0, restitution=0.0,
            linearDamping=0.0, angularDamping=0.0, jointDamping=0.0,
            localInertiaDiagonal=body.inertia,
            activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
        )  # fmt: skip
        return number, link

    def step(self, wrenches: dict[str, np.ndarray]) -> None:
        for name, (force, torque) in wrenches.items():
            number, link = self.links[name]
            place = self.pose(name)[:3]
            world = pybullet.WORLD_FRAME
            self.bullet.applyExternalForce(number, link, force, place, world)
            self.bullet.applyExternalTorque(number, link, torque, world)
        self.bullet.stepSimulation()

    def pose(self, name: str) -> list[float]:
        number, link = self.links[name]
        if link < 0:
            place, quaternion = self.bullet.getBasePositionAndOrientation(number)
        else:
            place, quaternion = self.bullet.getLinkState(number, link)[:2]
        return [*place, *quaternion]

    def normal_forces(self) -> list[tuple[np.ndarray, float]]:
        return [(np.array(c[5]), c[9]) for c in self.bullet.getContactPoints()]
