"""A state of a Drake plant as a step: what Drake says of it, without its velocity and compliance.

What is used: masses, joints that are not locked and their limits, gravity, springs of joints,
actuation and applied generalised forces, collision geometries as signed distances, and their
friction. Without effect are velocities, damping, compliance, hydroelastic properties and gains of
controllers. Refused are other force elements, constraints, deformable bodies, applied spatial
forces, and limits of joints with several coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.guests.mujoco import Coordinates
from quasistatic_ref.parts import needed_package
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import Extra, StepData

SPRINGS = ("RevoluteSpring", "PrismaticSpring")
GRAVITY = "UniformGravityFieldElement"
MARGIN = 0.1
"""Gap up to which Drake looks for contacts, by default [m]."""


def drake_step(
    plant: Any,
    context: Any,
    h: float,
    stiffness: Mapping[str, float],
    targets: Mapping[str, float] | None = None,
    margin: float = MARGIN,
) -> tuple[StepData, Coordinates]:
    """The step that begins in a state of a Drake plant, at rest.

    Parameters
    ----------
    plant : pydrake.multibody.plant.MultibodyPlant
        Finalised, in a diagram with its scene graph.
    context : pydrake.systems.framework.Context
        The plant's own, of the diagram's. It is not changed; its velocity is dropped.
    h : float
        Time step [s].
    stiffness : mapping of str to float
        Of actuated joints, which have one coordinate [N/m, N m/rad], by name; ``arm::elbow`` where
        several model instances have one of that name.
    targets : mapping of str to float, optional
        Their targets [m, rad]; by default where they are.
    margin : float
        Gap up to which Drake looks for contacts [m]: one of each pair of geometries.

    Returns
    -------
    StepData
    Coordinates
        `T` gives Drake's velocity times h, which ``MapVelocityToQDot`` maps.

    Raises
    ------
    ModelError
        Naming what no step can say.

    Examples
    --------
    >>> import pydrake.all as drake
    >>> builder = drake.DiagramBuilder()
    >>> plant, _ = drake.AddMultibodyPlantSceneGraph(builder, 0.0)
    >>> ball = plant.AddRigidBody("ball", drake.SpatialInertia.SolidSphereWithMass(0.3, 0.1))
    >>> rubs, at = drake.CoulombFriction(0.5, 0.5), drake.RigidTransform([0, 0, 0.1])
    >>> here = drake.RigidTransform()
    >>> _ = plant.RegisterCollisionGeometry(ball, here, drake.Sphere(0.1), "ball", rubs)
    >>> floor = drake.HalfSpace()
    >>> _ = plant.RegisterCollisionGeometry(plant.world_body(), here, floor, "floor", rubs)
    >>> plant.Finalize()
    >>> root = builder.Build().CreateDefaultContext()
    >>> context = plant.GetMyContextFromRoot(root)
    >>> plant.SetFreeBodyPose(context, ball, at)
    >>> step, coordinates = qr.drake_step(plant, context, h=0.01, stiffness={})
    >>> qr.solve_step(step).forces[0, 2].round(3)  # the weight [N]
    np.float64(2.943)
    """
    drake = needed_package("pydrake.all", "drake", "drake_step")
    check(plant)
    own = plant.CreateDefaultContext()
    own.SetTimeStateAndParametersFrom(context)
    plant.SetVelocities(own, np.zeros(plant.num_velocities()))
    joints = {
        scoped(plant, joint): joint for joint in map(plant.get_joint, plant.GetJointIndices())
    }
    K, of_springs = springs(drake, plant, own, named(joints), stiffness, targets or {})
    moving = [j for j in joints.values() if j.num_velocities() and not j.is_locked(own)]
    free = np.sort([j.velocity_start() + i for j in moving for i in range(j.num_velocities())])
    dofs = np.concatenate([free[K[free] > 0], free[K[free] == 0]])
    n_a = int((K[dofs] > 0).sum())
    T = np.eye(plant.num_velocities())[:, dofs]
    M = plant.CalcMassMatrix(own)[np.ix_(dofs[n_a:], dofs[n_a:])]
    tau = (loads(drake, plant, context, own) - passive(drake, plant, own))[dofs]
    K_q = np.diag(K[dofs[:n_a]])
    step = StepData(
        h=h,
        K_q=K_q,
        M_u=(M + M.T) / 2,
        tau_a=tau[:n_a],
        tau_u=tau[n_a:],
        delta_q_bar_a=of_springs[dofs[:n_a]] / np.diag(K_q),  # Eq. (1)
        contacts=contacts(drake, plant, context, own, T, margin),
        extra=limits(plant, own, joints, dofs),
    )
    names = tuple(plant.GetVelocityNames()[i] for i in dofs)
    left_out = tuple(words(plant, context))
    return step, Coordinates(names, dofs, T, left_out, 0.0)


def scoped(plant: Any, joint: Any) -> str:
    """The name of a joint behind that of its model instance, ``arm::elbow``."""
    return f"{plant.GetModelInstanceName(joint.model_instance())}::{joint.name()}"


def named(joints: Mapping[str, Any]) -> dict[str, Any]:
    """Joints by their scoped names, and by their own where these are unique."""
    own = [joint.name() for joint in joints.values()]
    return {**joints, **{j.name(): j for j in joints.values() if own.count(j.name()) == 1}}


def check(plant: Any) -> None:
    """Refuse what no step can say: ModelError."""
    if plant.num_constraints():
        raise ModelError("are not supported; remove them", field="plant constraints")
    if plant.deformable_model().num_bodies():
        raise ModelError("is not supported: bodies are rigid", field="plant deformable_model")
    if not plant.geometry_source_is_registered():
        raise ModelError("has no scene graph, and so no signed distances", field="plant")


def springs(
    drake: Any, plant: Any, own: Any, joints: Mapping[str, Any], stiffness: Mapping[str, float],
    targets: Mapping[str, float],
) -> tuple[Array, Array]:  # fmt: skip
    """Stiffness and force of the springs of each velocity, (nv,) each [N/m, N m/rad; N, N m].

    `stiffness` and `targets` are those of :func:`drake_step` [m, rad].

    Raises
    ------
    ModelError
        Naming a joint that is not there or has several coordinates, or a stiffness.
    """
    K = np.zeros(plant.num_velocities())
    force = np.zeros(plant.num_velocities())
    for name in targets:
        if name not in stiffness:
            raise ModelError("has no stiffness", field=f"targets[{name}]", value=targets[name])
    for name, k in stiffness.items():
        if name not in joints or joints[name].num_velocities() != 1:
            raise ModelError("is no joint with one coordinate", field="stiffness", value=name)
        if not k > 0:
            raise ModelError("must be greater than 0", field=f"stiffness[{name}]", value=k)
        v = joints[name].velocity_start()
        here = joints[name].GetOnePosition(own)
        K[v] += k
        force[v] += k * (targets.get(name, here) - here)
    for element in elements(drake, plant, SPRINGS):
        v = element.joint().velocity_start()
        K[v] += element.stiffness()
        force[v] += passive_force(element, own)
    return K, force


def elements(drake: Any, plant: Any, kinds: tuple[str, ...]) -> Iterator[Any]:
    """Force elements of some kinds; ModelError, naming it, at one that no step has."""
    for i in range(plant.num_force_elements()):
        element = plant.get_force_element(drake.ForceElementIndex(i))
        kind = type(element).__name__
        if kind not in (*SPRINGS, GRAVITY):
            raise ModelError("is not supported", field=f"force element {i}", value=kind)
        if kind in kinds:
            yield element


def passive_force(spring: Any, own: Any) -> float:
    """The force of a spring of a joint [N, N m]."""
    kind = "angle" if type(spring).__name__ == SPRINGS[0] else "position"
    nominal = float(getattr(spring, f"nominal_{kind}")())
    return float(spring.stiffness()) * (nominal - float(spring.joint().GetOnePosition(own)))


def passive(drake: Any, plant: Any, own: Any) -> Array:
    """Forces of the springs that are force elements, (nv,) [N, N m]."""
    force = np.zeros(plant.num_velocities())
    for element in elements(drake, plant, SPRINGS):
        force[element.joint().velocity_start()] += passive_force(element, own)
    return force


def loads(drake: Any, plant: Any, context: Any, own: Any) -> Array:
    """All forces of elements and inputs at rest, (nv,) [N, N m]; ModelError for spatial ones."""
    forces = drake.MultibodyForces(plant)
    plant.CalcForceElementsContribution(own, forces)
    rest = np.zeros(plant.num_velocities())
    tau: Array = -plant.CalcInverseDynamics(own, rest, forces)
    port = plant.get_actuation_input_port()
    if port.HasValue(context):
        tau = tau + plant.MakeActuationMatrix() @ port.Eval(context)
    port = plant.get_applied_generalized_force_input_port()
    if port.HasValue(context):
        tau = tau + port.Eval(context)
    port = plant.get_applied_spatial_force_input_port()
    if port.HasValue(context) and len(port.Eval(context)):
        raise ModelError("are not supported; use generalised forces", field="applied_spatial_force")
    return tau


def contacts(drake: Any, plant: Any, context: Any, own: Any, T: Array, margin: float) -> Contacts:
    """One contact of each pair of geometries that is nearer than the margin [m].

    Parameters
    ----------
    drake : module
    plant, context, own : object
        Drake's.
    T : ndarray, shape (nv, n_v)
        [-].
    margin : float
        [m].

    Raises
    ------
    ModelError
        Naming a pair whose normal is not known.
    """
    query = plant.get_geometry_query_input_port().Eval(context)
    inspector = query.inspector()
    found = query.ComputeSignedDistancePairwiseClosestPoints(margin)
    world = plant.world_frame()
    names: list[str] = []
    phi, n, J, mu_v = [], [], [], []
    for pair in sorted(found, key=lambda pair: (pair.id_A.get_value(), pair.id_B.get_value())):
        relative = np.zeros((6, plant.num_velocities()))
        frictions = []
        for id_, at, side in ((pair.id_A, pair.p_ACa, 1.0), (pair.id_B, pair.p_BCb, -1.0)):
            body = plant.GetBodyFromFrameId(inspector.GetFrameId(id_))
            point = inspector.GetPoseInFrame(id_) @ at
            relative += side * plant.CalcJacobianSpatialVelocity(
                own, drake.JacobianWrtVariable.kV, body.body_frame(), point, world, world
            )
            of_side = inspector.GetProximityProperties(id_)
            frictions.append(of_side.GetProperty("material", "coulomb_friction"))
        name = f"{inspector.GetName(pair.id_B)}/{inspector.GetName(pair.id_A)}"
        normal = np.asarray(pair.nhat_BA_W)
        if not np.isfinite(normal).all():
            raise ModelError("has no normal at this distance", field=f"pair {name}")
        along = relative @ T
        if not along.any():
            continue
        names.append(name)
        phi.append(pair.distance)
        n.append(normal)
        J.append(np.vstack([along[3:], normal @ along[:3]]))
        combined = drake.CalcContactFrictionFromSurfaceProperties(*frictions)
        mu_v.append(combined.static_friction())
    normals = np.array(n).reshape(-1, 3)
    d1, d2 = tangents(normals)
    return Contacts(
        name=tuple(names),
        phi=np.array(phi),
        n=normals,
        d1=d1,
        d2=d2,
        J=np.array(J).reshape(-1, 4, T.shape[1]),
        mu_v=np.array(mu_v),
        mu_omega=np.zeros(len(names)),
        rows=np.full(len(names), 4),
    )


def limits(plant: Any, own: Any, joints: Mapping[str, Any], dofs: Array) -> Extra:
    """Limits of joints as rows.

    Parameters
    ----------
    plant, own : object
        Drake's.
    joints : mapping of str to object
    dofs : ndarray of int, shape (n_v,)
        Drake's velocities of the coordinates.

    Raises
    ------
    ModelError
        Naming a joint with limits of several coordinates.
    """
    places = {int(dof): i for i, dof in enumerate(dofs)}
    names: list[str] = []
    A, b = [], []
    for name, joint in joints.items():
        ends = (joint.position_lower_limits(), joint.position_upper_limits())
        if not np.isfinite(ends).any() or not joint.num_velocities():
            continue
        if joint.num_velocities() > 1:
            raise ModelError("has limits of several coordinates", field=f"joint[{name}]")
        if joint.velocity_start() not in places:
            continue
        here = joint.GetOnePosition(own)
        for end, sign in zip(ends, (1.0, -1.0), strict=True):
            if np.isfinite(end[0]):
                names.append(f"limit of joint[{name}] ({len(names)})")
                A.append(sign * np.eye(len(dofs))[places[joint.velocity_start()]])
                b.append(sign * (end[0] - here))
    return Extra(tuple(names), np.array(A).reshape(-1, len(dofs)), np.array(b))


def words(plant: Any, context: Any) -> Iterator[str]:
    """What a step leaves out."""
    v = plant.GetVelocities(context)
    if v.any():
        yield f"velocity: dropped; its largest component is {np.abs(v).max():.2g}"
