"""Drake, by a discrete MultibodyPlant. A pair's friction is 2 a b / (a + b) of its bodies' own."""

from importlib.metadata import version
from typing import Any

import numpy as np
import pydrake.all as pydrake

from validation.programs.engines.scenes import TIME_STEP, Body, Scene, Shape

NAME = f"drake {version('drake')}"
NO_TORSION = "Drake's point contact has no torsional friction"
SETTINGS: dict[str, dict[str, Any]] = {
    name: {"discrete_contact_approximation": name} for name in ("sap", "similar", "lagged", "tamsi")
}
NOT_DEFAULT = (
    'contact_model = "point", for the default "hydroelastic_with_fallback". stiction_tolerance has '
    "its default, 1e-4 m/s, as have penetration_allowance and the relaxation time."
)
IDENTITY = pydrake.RigidTransform()


def solid(shape: Shape) -> Any:
    """A shape of Drake's."""
    return pydrake.Sphere(*shape.size) if shape.kind == "sphere" else pydrake.Box(*shape.size)


class Engine:
    """A scene as a plant, with point contact. A discrete plant uses dynamic friction alone."""

    def __init__(self, scene: Scene, setting: dict[str, Any]) -> None:
        builder = pydrake.DiagramBuilder()
        config = pydrake.MultibodyPlantConfig(
            time_step=TIME_STEP, contact_model="point", stiction_tolerance=1e-4, **setting
        )
        self.plant, _ = pydrake.AddMultibodyPlant(config, builder)
        self.plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -scene.gravity])
        self.material = pydrake.ProximityProperties()
        friction = pydrake.CoulombFriction(scene.mu_v, scene.mu_v)
        pydrake.AddContactMaterial(friction=friction, properties=self.material)
        if scene.floor:
            world = self.plant.world_body()
            floor = pydrake.HalfSpace()
            self.plant.RegisterCollisionGeometry(world, IDENTITY, floor, "floor", self.material)
        self.bodies = {body.name: self.added(body) for body in scene.bodies}
        self.plant.Finalize()
        self.simulator = pydrake.Simulator(builder.Build())
        root = self.simulator.get_mutable_context()
        self.context = self.plant.GetMyMutableContextFromRoot(root)

    def added(self, body: Body) -> Any:
        """A body, and its joint."""
        moments = pydrake.UnitInertia(*(np.array(body.inertia) / body.mass))
        inertia = pydrake.SpatialInertia(body.mass, np.zeros(3), moments)
        instance = self.plant.AddModelInstance(body.name)
        link = self.plant.AddRigidBody(body.name, instance, inertia)
        for k, shape in enumerate(body.shapes):
            place = pydrake.RigidTransform(shape.xyz)
            name = f"{body.name} {k}"
            self.plant.RegisterCollisionGeometry(link, place, solid(shape), name, self.material)
        place = pydrake.RigidTransform(body.xyz)
        world = self.plant.world_frame()
        if body.joint == "free":
            self.plant.SetDefaultFloatingBaseBodyPose(link, place)
        elif body.joint == "fixed":
            self.plant.WeldFrames(world, link.body_frame(), place)
        else:
            rail = self.plant.AddFrame(pydrake.FixedOffsetFrame(f"{body.name} rail", world, place))
            kind, axis = {
                "rail_x": (pydrake.PrismaticJoint, [1, 0, 0]),
                "hinge_z": (pydrake.RevoluteJoint, [0, 0, 1]),
            }[body.joint]
            self.plant.AddJoint(kind(body.name, rail, link.body_frame(), axis, damping=0))
        return link

    def step(self, wrenches: dict[str, np.ndarray]) -> None:
        forces = []
        for name, (force, torque) in wrenches.items():
            applied = pydrake.ExternallyAppliedSpatialForce()
            applied.body_index = self.bodies[name].index()
            applied.F_Bq_W = pydrake.SpatialForce(torque, force)
            forces.append(applied)
        self.plant.get_applied_spatial_force_input_port().FixValue(self.context, forces)
        self.simulator.AdvanceTo(self.simulator.get_context().get_time() + TIME_STEP)

    def pose(self, name: str) -> list[float]:
        place = self.plant.EvalBodyPoseInWorld(self.context, self.bodies[name])
        w, x, y, z = place.rotation().ToQuaternion().wxyz()
        return [*place.translation(), x, y, z, w]

    def normal_forces(self) -> list[tuple[np.ndarray, float]]:
        results = self.plant.get_contact_results_output_port().Eval(self.context)
        pairs = map(results.point_pair_contact_info, range(results.num_point_pair_contacts()))
        return [
            (pair.contact_point(), abs(float(pair.contact_force() @ pair.point_pair().nhat_BA_W)))
            for pair in pairs
        ]
