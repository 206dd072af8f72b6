"""A state of a Drake plant as a step: what Drake says of it, without its velocity and compliance.

``FATES`` says what becomes of each element: it is used, without effect, or refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import InputError, ModelError
from quasistatic_ref.optional.guests.drake_pairs import (
    STICTION,
    DrakeState,
    drake_pairs,
    drake_state,
)
from quasistatic_ref.optional.guests.state_step import (
    Coordinates,
    contacts_of,
    dropped,
    quasi_dynamic_number,
    step_from,
    takes_as_is,
)
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.data import Extra, StepData

if TYPE_CHECKING:
    from pydrake.all import (
        Context,
        ForceElement,
        Joint,
        MultibodyPlant,
    )

FATES = {
    "used": """
        WeldJoint PrismaticJoint RevoluteJoint ScrewJoint UniversalJoint PlanarJoint BallRpyJoint
        RpyFloatingJoint QuaternionFloatingJoint
        UniformGravityFieldElement RevoluteSpring PrismaticSpring
        Box Capsule Convex Cylinder Ellipsoid HalfSpace Mesh Sphere
        geometry_query actuation applied_generalized_force
        joint.position_limits joint.locked actuator.rotor_inertia actuator.gear_ratio
        coulomb_friction
    """,
    "without effect": """
        velocity desired_state joint.damping joint.velocity_limits joint.acceleration_limits
        actuator.controller_gains actuator.effort_limit
        contact_model discrete_contact_approximation stiction_tolerance penetration_allowance
        point_contact_stiffness hunt_crossley_dissipation relaxation_time hydroelastic
    """,
    "refused": """
        LinearSpringDamper DoorHinge LinearBushingRollPitchYaw
        applied_spatial_force constraints deformable_model
        limits_of_several_coordinates MeshcatCone
    """,
}
"""What becomes of each joint, force element, shape, port and property that Drake has."""
SPRINGS = ("RevoluteSpring", "PrismaticSpring")
GRAVITY = "UniformGravityFieldElement"
MARGIN = 0.1
"""Gap up to which two geometries have contacts, by default [m]."""


def drake_step(
    plant: MultibodyPlant,
    context: Context,
    h: float,
    stiffness: Mapping[str, float],
    targets: Mapping[str, float] | None = None,
    margin: float = MARGIN,
    depth: str = "closed",
    stiction_tolerance: float = STICTION,
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
        Gap up to which two geometries have contacts [m].
    depth : str
        ``"closed"``: contacts and limits that are violated count as closed, and with a contact the
        corners of the same two geometries that are off by less than a thousandth of the smaller
        one's size: Drake has one contact of them, on which they rock. ``"as is"``: one step closes
        what is violated.
    stiction_tolerance : float
        Slip up to which friction is static in a continuous plant [m/s]: that of its
        ``set_stiction_tolerance``, which Drake does not hand out. A discrete plant knows dynamic
        friction alone.

    Returns
    -------
    StepData
    Coordinates
        `T` gives Drake's velocity times h, which ``MapVelocityToQDot`` maps.

    Raises
    ------
    InputError
        If `depth` is another word, or `stiction_tolerance` is no speed.
    ContactError
        Naming a pair of geometries without a normal.
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
    as_is = takes_as_is(depth)
    if not 0 < stiction_tolerance < np.inf:
        problem = "must be a positive speed [m/s]"
        raise InputError(problem, field="stiction_tolerance", value=stiction_tolerance)
    state = drake_state(plant, context)
    still = state.still
    joints = {
        scoped(plant, joint): joint for joint in map(plant.get_joint, plant.GetJointIndices())
    }
    K, of_springs, of_elements = springs(state, named(joints), stiffness, targets or {})
    moving = [j for j in joints.values() if j.num_velocities() and not j.is_locked(still)]
    free = np.sort([j.velocity_start() + i for j in moving for i in range(j.num_velocities())])
    dofs = np.concatenate([free[K[free] > 0], free[K[free] == 0]])
    n_a = int((K[dofs] > 0).sum())
    T = np.eye(plant.num_velocities())[:, dofs]
    M = plant.CalcMassMatrix(still)[np.ix_(dofs[n_a:], dofs[n_a:])]
    tau = (loads(state) - of_elements)[dofs]
    K_q = np.diag(K[dofs[:n_a]])
    touching = [
        contact
        for pair in drake_pairs(state, margin, stiction_tolerance)
        for contact in pair.contacts
        if (contact.J @ T).any()
    ]
    step = step_from(
        h, K_q, M, tau, of_springs[dofs],
        contacts=contacts_of(touching, T, as_is), extra=limits(state, joints, dofs, as_is),
    )  # fmt: skip
    names = tuple(plant.GetVelocityNames()[i] for i in dofs)
    v = plant.GetVelocities(context)
    left_out = (*dropped(v, touching), *gain_words(plant))
    number = quasi_dynamic_number(touching, v, plant.gravity_field().gravity_vector(), h)
    return step, Coordinates(names, T, left_out, number)


def scoped(plant: MultibodyPlant, joint: Joint) -> str:
    """The name of a joint behind that of its model instance, ``arm::elbow``."""
    return f"{plant.GetModelInstanceName(joint.model_instance())}::{joint.name()}"


def named(joints: Mapping[str, Joint]) -> dict[str, Joint]:
    """Joints by their scoped names, and by their own where these are unique."""
    names = [joint.name() for joint in joints.values()]
    return {**joints, **{j.name(): j for j in joints.values() if names.count(j.name()) == 1}}


def springs(
    state: DrakeState, joints: Mapping[str, Joint],
    stiffness: Mapping[str, float], targets: Mapping[str, float],
) -> tuple[Array, Array, Array]:  # fmt: skip
    """Stiffness and force of the springs of each velocity, and the force of force elements alone.

    (nv,) each [N/m, N m/rad; N, N m; N, N m].

    `stiffness` and `targets` are those of :func:`drake_step` [m, rad].

    Raises
    ------
    ModelError
        Naming a joint that is not there or has several coordinates, or a stiffness.
    """
    K, force, of_elements = np.zeros((3, state.plant.num_velocities()))
    for name in targets:
        if name not in stiffness:
            raise ModelError("has no stiffness", field=f"targets[{name}]", value=targets[name])
    for name, k in stiffness.items():
        if name not in joints or joints[name].num_velocities() != 1:
            raise ModelError("is no joint with one coordinate", field="stiffness", value=name)
        if not k > 0:
            raise ModelError("must be greater than 0", field=f"stiffness[{name}]", value=k)
        v = joints[name].velocity_start()
        here = joints[name].GetOnePosition(state.still)
        K[v] += k
        force[v] += k * (targets.get(name, here) - here)
    for element in elements(state):
        v = element.joint().velocity_start()
        K[v] += element.stiffness()
        of_elements[v] += passive_force(element, state.still)
    return K, force + of_elements, of_elements


def elements(state: DrakeState) -> Iterator[ForceElement]:
    """The springs among force elements; ModelError, naming it, at one that no step has."""
    for i in range(state.plant.num_force_elements()):
        element = state.plant.get_force_element(state.drake.ForceElementIndex(i))
        kind = type(element).__name__
        if kind not in (*SPRINGS, GRAVITY):
            raise ModelError("is not supported", field=f"force element {i}", value=kind)
        if kind in SPRINGS:
            yield element


def passive_force(spring: ForceElement, still: Context) -> float:
    """The force of a spring of a joint [N, N m]."""
    kind = "angle" if type(spring).__name__ == SPRINGS[0] else "position"
    nominal = float(getattr(spring, f"nominal_{kind}")())
    return float(spring.stiffness()) * (nominal - float(spring.joint().GetOnePosition(still)))


def loads(state: DrakeState) -> Array:
    """All forces of elements and inputs at rest, (nv,) [N, N m]; ModelError for spatial ones."""
    drake, plant, context, still = state
    forces = drake.MultibodyForces(plant)
    plant.CalcForceElementsContribution(still, forces)
    rest = np.zeros(plant.num_velocities())
    tau: Array = -plant.CalcInverseDynamics(still, rest, forces)
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


def limits(state: DrakeState, joints: Mapping[str, Joint], dofs: Array, as_is: bool) -> Extra:
    """Limits of joints as rows.

    Parameters
    ----------
    state : DrakeState
    joints : mapping of str to object
    dofs : ndarray of int, shape (n_v,)
        Drake's velocities of the coordinates.
    as_is : bool
        Whether limits that are violated are; else they count as closed.

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
        here = joint.GetOnePosition(state.still)
        for end, sign in zip(ends, (1.0, -1.0), strict=True):
            if np.isfinite(end[0]):
                names.append(f"limit of joint[{name}] ({len(names)})")
                A.append(sign * np.eye(len(dofs))[places[joint.velocity_start()]])
                short = sign * (end[0] - here)
                b.append(short if as_is else min(short, 0.0))
    return Extra(tuple(names), np.array(A).reshape(-1, len(dofs)), np.array(b))


def gain_words(plant: MultibodyPlant) -> Iterator[str]:
    """What a step leaves out of actuators."""
    for index in plant.GetJointActuatorIndices():
        actuator = plant.get_joint_actuator(index)
        if actuator.has_controller():
            gains = "its gains are without effect; a spring is one of `stiffness`"
            yield f"actuator[{actuator.name()}]: {gains}"
