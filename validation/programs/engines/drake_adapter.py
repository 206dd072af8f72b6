"""Drake: phenomena by its discrete MultibodyPlant."""

from importlib.metadata import version
from typing import Any

import numpy as np
import pydrake.all as drake
from door import aims, answer, run

SOLIDS = {
    "sphere": lambda s: drake.Sphere(s["radius"]),
    "box": lambda s: drake.Box(*s["size"]),
}


def plant_of(scene: Any, setting: Any) -> tuple[Any, Any]:
    """Plant and diagram of a scene."""
    builder = drake.DiagramBuilder()
    config = drake.MultibodyPlantConfig(
        time_step=setting["h"],
        contact_model=setting["contact_model"],
        discrete_contact_approximation=setting["approximation"],
        **setting.get("plant", {}),
    )
    plant, _ = drake.AddMultibodyPlant(config, builder)
    plant.mutable_gravity_field().set_gravity_vector(scene["gravity"])
    properties = drake.ProximityProperties()
    friction = drake.CoulombFriction(scene["mu_v"], scene["mu_v"])
    drake.AddContactMaterial(
        friction=friction, properties=properties, dissipation=setting.get("dissipation")
    )
    if "relaxation_time" in setting:
        properties.AddProperty("material", "relaxation_time", setting["relaxation_time"])
    soft = drake.ProximityProperties(properties)
    if setting["contact_model"] == "hydroelastic":
        drake.AddCompliantHydroelasticProperties(0.01, 1e7, soft)
        drake.AddRigidHydroelasticProperties(0.01, properties)
    identity = drake.RigidTransform()
    if scene["floor"]:
        plant.RegisterCollisionGeometry(
            plant.world_body(), identity, drake.HalfSpace(), "floor", properties
        )
    for body in scene["bodies"]:
        inertia = drake.SpatialInertia(
            body["mass"], np.zeros(3),
            drake.UnitInertia(*(np.array(body["inertia"]) / body["mass"])),
        )  # fmt: skip
        added = plant.AddRigidBody(body["name"], plant.AddModelInstance(body["name"]), inertia)
        for k, shape in enumerate(body["shapes"]):
            solid = SOLIDS[shape["kind"]](shape)
            inside = drake.RigidTransform(shape["xyz"])
            plant.RegisterCollisionGeometry(added, inside, solid, f"{body['name']} {k}", soft)
        at = drake.RigidTransform(body["xyz"])
        if body["joint"] == "fixed":
            plant.WeldFrames(plant.world_frame(), added.body_frame(), at)
        elif body["joint"] == "rail_x":
            frame = plant.AddFrame(
                drake.FixedOffsetFrame(body["name"] + "_rail", plant.world_frame(), at)
            )
            plant.AddJoint(drake.PrismaticJoint(body["name"], frame, added.body_frame(), [1, 0, 0]))
        elif body["joint"] == "servo":
            add_servo(plant, body, added)
        else:
            plant.SetDefaultFloatingBaseBodyPose(added, at)
    plant.Finalize()
    return plant, builder.Build()


def add_servo(plant: Any, body: Any, added: Any) -> None:
    """Rails along x, y and z, each with a spring to its target and critical damping."""
    gains = drake.PdControllerGains(p=body["K"], d=2 * float(np.sqrt(body["K"] * body["mass"])))
    instance = added.model_instance()
    at = drake.RigidTransform(body["xyz"])
    frame = plant.AddFrame(drake.FixedOffsetFrame(f"{body['name']}_rail", plant.world_frame(), at))
    for axis, direction in zip("xyz", np.eye(3), strict=True):
        name = f"{body['name']}/{axis}"
        light = drake.SpatialInertia.SolidSphereWithMass(1e-6, 0.01)
        moved = added if axis == "z" else plant.AddRigidBody(name, instance, light)
        joint = drake.PrismaticJoint(name, frame, moved.body_frame(), direction)
        actuator = plant.AddJointActuator(name, plant.AddJoint(joint))
        actuator.set_controller_gains(gains)
        frame = moved.body_frame()
    plant.set_gravity_enabled(instance, False)


def phenomena(scene: Any, setting: Any) -> Any:
    """A scene, by the simulator."""
    plant, diagram = plant_of(scene, setting)
    simulator = drake.Simulator(diagram)
    context = simulator.get_mutable_context()
    within = plant.GetMyMutableContextFromRoot(context)
    port = plant.get_applied_spatial_force_input_port()
    bodies = {b["name"]: plant.GetBodyByName(b["name"]) for b in scene["bodies"]}

    def step(loads: Any) -> None:
        forces = []
        for name, (force, torque) in loads.items():
            applied = drake.ExternallyAppliedSpatialForce()
            applied.body_index = bodies[name].index()
            applied.F_Bq_W = drake.SpatialForce(torque, force)
            forces.append(applied)
        port.FixValue(within, forces)
        simulator.AdvanceTo(context.get_time() + setting["h"])

    servos = [body["name"] for body in scene["bodies"] if body["joint"] == "servo"]

    def aim(t: float) -> None:
        targets = aims(scene, t + setting["h"])  # the spring is implicit
        for name in servos:
            instance = plant.GetModelInstanceByName(name)
            plant.get_desired_state_input_port(instance).FixValue(within, np.ravel(targets[name]))

    def pose(name: str) -> Any:
        X = plant.EvalBodyPoseInWorld(within, bodies[name])
        w, x, y, z = X.rotation().ToQuaternion().wxyz()
        return [*X.translation(), x, y, z, w]

    return run(scene, setting["h"], step, pose, aim if servos else None)


if __name__ == "__main__":
    answer(f"drake {version('drake')}", phenomena)
