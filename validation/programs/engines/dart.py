"""DART, through dartpy. A pair's friction is the smaller of its bodies' coefficients."""

from importlib.metadata import version
from typing import Any

import dartpy
import numpy as np

from validation.programs.engines.scenes import TIME_STEP, Body, Scene, Shape

NAME = f"dart (dartpy {version('dartpy')})"
NO_TORSION = "DART has no torsional friction at a point"
SETTINGS: dict[str, dict[str, Any]] = {
    "FCL": {"detector": "FCLCollisionDetector"},
    "Bullet's detector": {"detector": "BulletCollisionDetector"},
    "ODE's detector": {"detector": "OdeCollisionDetector"},
    "DART's detector": {"detector": "DARTCollisionDetector"},
}
NOT_DEFAULT = (
    "The floor is a box of 10 by 10 by 1 m, since not every detector knows a plane; bodies are not "
    "deactivated. The solver of the LCP is DART's default."
)


class Engine:
    """A scene in a DART world."""

    def __init__(self, scene: Scene, setting: dict[str, Any]) -> None:
        self.world = dartpy.simulation.World()
        self.world.setTimeStep(TIME_STEP)
        self.world.setGravity([0.0, 0.0, -scene.gravity])
        deactivation = self.world.getDeactivationOptions()
        deactivation.mEnabled = False
        self.world.setDeactivationOptions(deactivation)
        detector = getattr(dartpy.collision, setting["detector"])()
        self.world.getConstraintSolver().setCollisionDetector(detector)
        self.friction = scene.mu_v
        if scene.floor:
            ground = Shape("box", (10.0, 10.0, 1.0))
            floor = Body("floor", "fixed", 1.0, (1.0, 1.0, 1.0), (0.0, 0.0, -0.5), (ground,))
            self.added(floor)
        self.bodies = {body.name: self.added(body) for body in scene.bodies}

    def added(self, body: Body) -> Any:
        """A body, in a skeleton of its own."""
        skeleton = dartpy.dynamics.Skeleton(body.name)
        joint, node = {
            "free": skeleton.createFreeJointAndBodyNodePair,
            "fixed": skeleton.createWeldJointAndBodyNodePair,
            "rail_x": skeleton.createPrismaticJointAndBodyNodePair,
            "hinge_z": skeleton.createRevoluteJointAndBodyNodePair,
        }[body.joint]()
        place = dartpy.math.Isometry3()
        place.set_translation(body.xyz)
        if body.joint == "free":
            joint.setPositions(np.array([0.0, 0.0, 0.0, *body.xyz]))
        else:
            joint.setTransformFromParentBodyNode(place)
        if body.joint == "rail_x":
            joint.setAxis([1.0, 0.0, 0.0])
        elif body.joint == "hinge_z":
            joint.setAxis([0.0, 0.0, 1.0])
        node.setInertia(dartpy.dynamics.Inertia(body.mass, np.zeros(3), np.diag(body.inertia)))
        for shape in body.shapes:
            kind = (
                dartpy.dynamics.SphereShape if shape.kind == "sphere" else dartpy.dynamics.BoxShape
            )
            size = shape.size[0] if shape.kind == "sphere" else shape.size
            frame = node.createShapeNode(kind(size))
            frame.setRelativeTranslation(shape.xyz)
            frame.createCollisionAspect()
            contact = frame.createDynamicsAspect()
            contact.setFrictionCoeff(self.friction)
            contact.setRestitutionCoeff(0.0)
        self.world.addSkeleton(skeleton)
        return node

    def step(self, wrenches: dict[str, np.ndarray]) -> None:
        for name, (force, torque) in wrenches.items():
            if np.any([force, torque]):
                self.bodies[name].addExtForce(force, np.zeros(3), False, True)
                self.bodies[name].addExtTorque(torque, False)
        self.world.step()

    def pose(self, name: str) -> list[float]:
        place = self.bodies[name].getTransform()
        w, x, y, z = place.quaternion().wxyz()
        return [*place.translation(), x, y, z, w]

    def normal_forces(self) -> list[tuple[np.ndarray, float]]:
        contacts = self.world.getLastCollisionResult().getContacts()
        return [(contact.point, abs(contact.force @ contact.normal)) for contact in contacts]
