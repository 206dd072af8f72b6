"""What Drake says of the contacts of a state, and the second opinion on it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.guests.compared import WINDOW, EngineState, Mover, Touch
from quasistatic_ref.optional.guests.drake import MARGIN, drake_step
from quasistatic_ref.optional.guests.drake_pairs import (
    STICTION,
    DrakeState,
    Pair,
    ball_about,
    called,
    drake_pairs,
    drake_state,
    jacobian,
)
from quasistatic_ref.optional.guests.findings import Words
from quasistatic_ref.optional.guests.opinion import Opinion, opinion_of
from quasistatic_ref.parts import needed_package
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import CREEP

if TYPE_CHECKING:
    from pydrake.all import (
        ContactResults,
        Context,
        Diagram,
        GeometryId,
        MultibodyPlant,
    )

CONTINUOUS = 1e-3
"""Time step of the exact answer where a plant has none [s]."""


def drake_opinion(
    diagram: Diagram,
    context: Context,
    stiffness: Mapping[str, float] | None = None,
    targets: Mapping[str, float] | None = None,
    tolerance: float = CREEP,
    margin: float = MARGIN,
    stiction_tolerance: float = STICTION,
) -> Opinion:
    """What Drake says of the contacts of a state, and what rigid bodies with that friction do.

    Parameters
    ----------
    diagram : pydrake.systems.framework.Diagram
        With one plant and its scene graph, and what drives them.
    context : pydrake.systems.framework.Context
        The diagram's. It is not changed. A state that has settled says most.
    stiffness, targets : mapping of str to float, optional
        Of actuated joints, as of ``drake_step`` [N/m, N m/rad; m, rad]: those of the controllers.
    tolerance : float
        Speed up to which a contact holds [m/s].
    margin : float
        Gap up to which two geometries have contacts [m].
    stiction_tolerance : float
        As of ``drake_step`` [m/s].

    Returns
    -------
    Opinion
        It prints as tables and sentences. Gaps that are violated count as closed. A contact is
        that of two geometries: Drake's force on them, and the sum of the exact ones at the corners
        of their faces. Drake's forces are those of a step from the state itself: those that its
        output port keeps are of the step before, whatever has been set since.

    Raises
    ------
    InputError
        If `tolerance` is not positive.
    ModelError
        As of ``drake_step``, and if there is another number of plants, or Drake cannot go on.

    Examples
    --------
    >>> import pydrake.all as drake
    >>> builder = drake.DiagramBuilder()
    >>> plant, _ = drake.AddMultibodyPlantSceneGraph(builder, 0.001)
    >>> ball = plant.AddRigidBody("ball", drake.SpatialInertia.SolidSphereWithMass(0.3, 0.1))
    >>> rubs, at = drake.CoulombFriction(0.5, 0.5), drake.RigidTransform([0, 0, 0.0999])
    >>> here = drake.RigidTransform()
    >>> _ = plant.RegisterCollisionGeometry(ball, here, drake.Sphere(0.1), "ball", rubs)
    >>> floor = drake.HalfSpace()
    >>> _ = plant.RegisterCollisionGeometry(plant.world_body(), here, floor, "floor", rubs)
    >>> plant.Finalize()
    >>> diagram = builder.Build()
    >>> context = diagram.CreateDefaultContext()
    >>> plant.SetFreeBodyPose(plant.GetMyContextFromRoot(context), ball, at)
    >>> simulator = drake.Simulator(diagram, context.Clone())
    >>> _ = simulator.AdvanceTo(1.0)
    >>> opinion = qr.drake_opinion(diagram, simulator.get_context())
    >>> opinion.findings, round(opinion.contacts[0].exact.normal, 4)  # the weight [N]
    ((), 2.943)
    """
    drake = needed_package("pydrake.all", "drake", "drake_opinion")
    plants = [s for s in diagram.GetSystems() if isinstance(s, drake.MultibodyPlant)]
    if len(plants) != 1:
        raise ModelError(
            "must have one plant: build a diagram for each", field="diagram", value=len(plants)
        )
    (plant,) = plants
    step_of = partial(
        drake_step, plant, plant.GetMyContextFromRoot(context), stiffness=stiffness or {},
        targets=targets, margin=margin, stiction_tolerance=stiction_tolerance,
    )  # fmt: skip
    h = float(plant.time_step()) or CONTINUOUS
    step_of(h)  # refuses what no step can say
    of_plant = drake_state(plant, plant.GetMyContextFromRoot(context))
    still = of_plant.still
    copied = context.Clone()  # it must outlive the plant's context in it
    evaluated = after_step(plant, copied)
    pairs = drake_pairs(of_plant, margin, stiction_tolerance)
    mean, later = velocities(drake, diagram, plant, context)
    gravity = np.array(plant.gravity_field().gravity_vector())
    state = EngineState(
        touches=tuple(touches(of_plant, evaluated, pairs)),
        movers=tuple(movers(of_plant)),
        M=plant.CalcMassMatrix(still),
        gravity=gravity,
        v=plant.GetVelocities(of_plant.context),
        acceleration=plant.get_generalized_acceleration_output_port().Eval(evaluated),
        mean=mean,
        later=later,
    )
    weight = float(plant.CalcTotalMass(still) * np.linalg.norm(gravity))
    return opinion_of(state, step_of, h, tolerance, words(drake, plant), weight)


def words(drake: ModuleType, plant: MultibodyPlant) -> Words:
    """What sentences call Drake's options."""
    sap = plant.time_step() and (
        plant.get_discrete_contact_approximation() == drake.DiscreteContactApproximation.kSap
    )
    slower = "time_step" if sap else "stiction tolerance by set_stiction_tolerance"
    return Words(
        engine="Drake",
        yields="Drake documents that it regularises friction near rest",
        slower=f"take a smaller {slower}",
        stronger="raise coulomb_friction, or what presses the bodies together",
        spins="take geometries with more points of contact; Drake has no torsional friction",
        rests="do without what Drake has and a step has not: damping of joints, gains",
        stiffer="raise point_contact_stiffness, or take lighter bodies",
        apart="move the bodies, or filter collisions of those that may overlap",
    )


def velocities(
    drake: ModuleType, diagram: Diagram, plant: MultibodyPlant, context: Context
) -> tuple[Array, Array]:
    """Drake's mean velocity over a WINDOW, and over the one after it, (nv,) each.

    Raises
    ------
    ModelError
        If Drake cannot go on.
    """
    simulator = drake.Simulator(diagram, context.Clone())
    now = plant.GetMyContextFromRoot(simulator.get_mutable_context())
    means = []
    for _ in range(2):
        start = plant.GetPositions(now).copy()
        began = simulator.get_context().get_time()
        try:
            simulator.AdvanceTo(began + WINDOW)
        except RuntimeError as error:
            raise stopped(error) from error
        rate = (plant.GetPositions(now) - start) / WINDOW
        means.append(np.array(plant.MapQDotToVelocity(now, rate)))
    return means[0], means[1]


def stopped(error: RuntimeError) -> ModelError:
    """The refusal of a state from which Drake cannot go on."""
    reason = str(error).splitlines()[0]
    problem = f"cannot go on: {reason}; take a smaller time_step or another state"
    return ModelError(problem, field="context")


def after_step(plant: MultibodyPlant, root: Context) -> Context:
    """The plant's context in a copy of the diagram's, `root`, with outputs of its own state.

    The outputs of a discrete plant are sampled: they are those of the step that ends in a state.
    One step of the copy makes those of the step that begins in it.

    Raises
    ------
    ModelError
        If Drake cannot take that step.
    """
    of_plant = plant.GetMyMutableContextFromRoot(root)
    if plant.time_step():
        try:
            plant.ExecuteForcedEvents(of_plant)
        except RuntimeError as error:
            raise stopped(error) from error
    return of_plant


def forces(
    results: ContactResults,
) -> dict[tuple[GeometryId, GeometryId], tuple[Array, Array | None]]:
    """The force on the second of two geometries, (3,) [N], and where it acts, (3,) [m]."""
    known: dict[tuple[GeometryId, GeometryId], tuple[Array, Array | None]] = {}
    for i in range(results.num_point_pair_contacts()):
        info = results.point_pair_contact_info(i)
        A, B = info.point_pair().id_A, info.point_pair().id_B
        known[A, B] = np.asarray(info.contact_force()), np.asarray(info.contact_point())
    for i in range(results.num_hydroelastic_contacts()):
        of_surface = results.hydroelastic_contact_info(i)
        surface = of_surface.contact_surface()
        on_first = np.asarray(of_surface.F_Ac_W().translational())
        known[surface.id_M(), surface.id_N()] = -on_first, np.asarray(surface.centroid())
    return known | {(B, A): (-force, at) for (A, B), (force, at) in known.items()}


def touches(state: DrakeState, evaluated: Context, pairs: list[Pair]) -> Iterator[Touch]:
    """Pairs of geometries that are closed, or that Drake presses on each other.

    Parameters
    ----------
    state : DrakeState
    evaluated : object
        Drake's context, with the outputs of the state.
    pairs : list of Pair
    """
    known = forces(state.plant.get_contact_results_output_port().Eval(evaluated))
    for pair in pairs:
        nearest = min(pair.contacts, key=lambda contact: contact.phi)
        force, at = known.get(pair.geometries, (np.zeros(3), None))
        if at is None and nearest.phi > 0:
            continue
        slides = [contact for contact in pair.contacts if contact.closed] or [nearest]
        if at is not None:  # its slip is that where its force acts
            J = jacobian(state, pair.bodies, (at, at), nearest.frame[0])
            slides.insert(0, nearest._replace(J=J))
        f_n, f_d1, f_d2 = slides[0].frame @ force
        names = tuple(contact.name for contact in pair.contacts)
        wrench = np.array([f_d1, f_d2, f_n, 0.0])
        yield Touch(nearest.pair, nearest, names, tuple(slides), wrench)


def movers(state: DrakeState) -> Iterator[Mover]:
    """The bodies that can move, each with all that is welded to it."""
    drake, plant, context, still = state
    inspector = plant.get_geometry_query_input_port().Eval(context).inspector()
    world = plant.world_frame()
    M = plant.CalcMassMatrix(still)
    seen = {"world"}
    for i in range(plant.num_bodies()):
        body = plant.get_body(drake.BodyIndex(i))
        name = called(plant, body)
        if name in seen:
            continue
        seen.add(name)
        group = plant.GetBodiesWeldedTo(body)
        masses = np.array([one.get_mass(still) for one in group])
        places = [plant.EvalBodyPoseInWorld(still, one) for one in group]
        centres = np.array([
            X @ one.CalcCenterOfMassInBodyFrame(still) for X, one in zip(places, group, strict=True)
        ])  # fmt: skip
        centre = masses @ centres / masses.sum() if masses.sum() else centres[0]
        at = plant.EvalBodyPoseInWorld(still, body).inverse() @ centre
        J = plant.CalcJacobianSpatialVelocity(
            still, drake.JacobianWrtVariable.kV, body.body_frame(), at, world, world
        )
        moves = J.any(axis=0)
        floats = any(one.is_floating_base_body() for one in group)
        free = floats and not M[np.ix_(moves, ~moves)].any()
        balls = [
            ball_about(inspector, geometry, X @ inspector.GetPoseInFrame(geometry))
            for X, one in zip(places, group, strict=True)
            for geometry in plant.GetCollisionGeometriesForBody(one)
        ]
        reaches = [float(np.linalg.norm(ball[0] - centre)) + ball[1] for ball in balls if ball]
        size = max(reaches, default=0.0)
        yield Mover(name, float(masses.sum()), size, bool(free), J[3:], J[:3])
