"""The contacts of a Drake plant: its geometries at their poses, as shapes of this package.

Shapes, gaps, normals and the corners of faces are the package's own. Drake's filters say which
geometries may touch, and its properties how they rub.
"""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import number_within, pair_closest_points
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.guests.state_step import StateContact
from quasistatic_ref.parts import needed_package
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    PlacedShape,
    Shape,
    Sphere,
)
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import DEEP, LIES_FLAT

if TYPE_CHECKING:
    from pydrake.all import (
        Context,
        GeometryId,
        MultibodyPlant,
        RigidBody,
        RigidTransform,
        SceneGraphInspector,
    )

STICTION = 1e-3
"""Slip up to which the friction of a continuous plant is static, Drake's default [m/s]."""
STRIBECK = 3.0
"""Slip over that, from which on the friction of a continuous plant is dynamic [-]."""
HULLS = ("Convex", "Mesh")
FEWEST = 4
"""Contacts of two shapes that may touch with a face: more where more corners are as near."""


class DrakeState(NamedTuple):
    """A plant in a state.

    Parameters
    ----------
    drake : module
    plant, context : object
        Drake's.
    still : object
        A context of the same configuration, without velocity.
    """

    drake: ModuleType
    plant: MultibodyPlant
    context: Context
    still: Context


def drake_state(plant: MultibodyPlant, context: Context) -> DrakeState:
    """A plant in a state.

    Raises
    ------
    ModelError
        If pydrake is not installed, or the plant has what no step can say.
    """
    drake = needed_package("pydrake.all", "drake", "drake_step")
    if plant.num_constraints():
        raise ModelError("are not supported; remove them", field="plant constraints")
    if plant.deformable_model().num_bodies():
        raise ModelError("is not supported: bodies are rigid", field="plant deformable_model")
    if not plant.geometry_source_is_registered():
        raise ModelError("has no scene graph, and so no signed distances", field="plant")
    still = plant.CreateDefaultContext()
    still.SetTimeStateAndParametersFrom(context)
    plant.SetVelocities(still, np.zeros(plant.num_velocities()))
    return DrakeState(drake, plant, context, still)


class Pair(NamedTuple):
    """Two geometries and their contacts.

    Parameters
    ----------
    geometries : tuple
        Drake's ids, alpha's first.
    bodies : tuple
        Drake's bodies.
    contacts : tuple of StateContact
        All are closed whose corners are nearer than LIES_FLAT, if one of them is.
    """

    geometries: tuple[GeometryId, GeometryId]
    bodies: tuple[RigidBody, RigidBody]
    contacts: tuple[StateContact, ...]


def drake_pairs(
    state: DrakeState, margin: float, stiction_tolerance: float = STICTION
) -> list[Pair]:
    """All pairs of geometries with contacts that are nearer than the margin [m].

    A pair of a name that another has, too, has a number in its name, and so has each of several
    contacts of a pair.

    Parameters
    ----------
    state : DrakeState
    margin : float
        [m].
    stiction_tolerance : float
        Slip up to which the friction of a continuous plant is static [m/s].

    Raises
    ------
    ContactError
        Naming a pair without a normal.
    ModelError
        Naming a geometry whose shape is none of a step.
    """
    drake, plant, context, _ = state
    query = plant.get_geometry_query_input_port().Eval(context)
    inspector = query.inspector()
    ids = sorted(inspector.GetAllGeometryIds(drake.Role.kProximity), key=lambda i: i.get_value())
    places = [query.GetPoseInWorld(i) for i in ids]
    R = np.array([X.rotation().matrix() for X in places]).reshape(-1, 3, 3)
    t = np.array([X.translation() for X in places]).reshape(-1, 3)
    shapes = [
        PlacedShape(inspector.GetName(i), link, np.eye(3), np.zeros(3), shape_of(inspector, i))
        for link, i in enumerate(ids)
    ]
    number = {i.get_value(): link for link, i in enumerate(ids)}
    candidates = sorted(
        sorted(number[i.get_value()] for i in two) for two in inspector.GetCollisionCandidates()
    )
    balls = [ball_about(inspector, i, X) for i, X in zip(ids, places, strict=True)]
    near = [(B, A) for A, B in candidates if balls_apart(balls[A], balls[B]) <= margin]
    names = [f"{shapes[B].name}/{shapes[A].name}" for B, A in near]
    pairs = []
    for i, (B, A) in enumerate(near):
        name = names[i] if names.count(names[i]) == 1 else f"{i}: {names[i]}"
        of_one = ContactPair(name, shapes[B], shapes[A], 0.0, 0.0, rows=4, k=1)
        of_pair = replace(of_one, k=places_of(of_one, R, t))
        points = pair_closest_points(of_pair, R, t)
        kept = np.flatnonzero(points.phi <= margin).tolist()
        size = min(shapes[link].shape.extent for link in (A, B))
        closed = (points.phi.min() <= 0) & (points.phi <= LIES_FLAT * size)
        frames = np.stack([points.n, *tangents(points.n)], axis=1)
        alpha, beta = (plant.GetBodyFromFrameId(inspector.GetFrameId(ids[k])) for k in (B, A))
        bodies = (called(plant, alpha), called(plant, beta))
        contacts = []
        for k in kept:
            J = jacobian(state, (alpha, beta), (points.alpha[k], points.beta[k]), points.n[k])
            numbered = name if len(kept) == 1 else f"{name}/{points.point[k]}"
            contact = StateContact(numbered, name, bodies, float(points.phi[k]), bool(closed[k]),
                                   frames[k], J, mu_v=0.0)  # fmt: skip
            slip = contact.slip(plant.GetVelocities(context))
            mu_v = friction(state, inspector, (ids[A], ids[B]), slip, stiction_tolerance)
            contacts.append(contact._replace(mu_v=mu_v))
        if contacts:
            pairs.append(Pair((ids[B], ids[A]), (alpha, beta), tuple(contacts)))
    return pairs


def called(plant: MultibodyPlant, body: RigidBody) -> str:
    """The name of what a body is welded to; ``"world"`` for what cannot move."""
    first = min(plant.GetBodiesWeldedTo(body), key=lambda one: int(one.index()))
    if first.index() == plant.world_body().index():
        return "world"
    alone = plant.NumBodiesWithName(first.name()) == 1
    return str(first.name() if alone else first.scoped_name())


def shape_of(inspector: SceneGraphInspector, geometry: GeometryId) -> Shape:
    """A geometry's shape, in its own frame; of a mesh its hull, which Drake's contacts are of.

    Raises
    ------
    ModelError
        Naming a geometry of another kind.
    """
    shape = inspector.GetShape(geometry)
    kind = type(shape).__name__
    if kind == "Sphere":
        return Sphere(shape.radius())
    if kind in ("Capsule", "Cylinder"):
        kinds = {"Capsule": Capsule, "Cylinder": Cylinder}
        return kinds[kind](shape.radius(), half_length=shape.length() / 2)
    if kind == "Box":
        return Box(size=shape.size())
    if kind == "Ellipsoid":
        return Ellipsoid([shape.a(), shape.b(), shape.c()])
    if kind == "HalfSpace":
        return HalfSpace(np.array([0.0, 0.0, 1.0]), 0.0)
    if kind not in HULLS:
        field = f"geometry[{inspector.GetName(geometry)}]"
        raise ModelError("has a shape that no step has; take another", field=field, value=kind)
    mesh = inspector.GetConvexHull(geometry)
    return convex_hull(np.array([mesh.vertex(i) for i in range(mesh.num_vertices())]))


Ball = tuple[Array, float]
"""A centre, (3,) [m], and a radius [m]."""


def ball_about(
    inspector: SceneGraphInspector, geometry: GeometryId, pose: RigidTransform
) -> Ball | None:
    """The ball about the box of a geometry at its pose; None of a half-space."""
    box = inspector.GetObbInGeometryFrame(geometry)
    if box is None:
        return None
    return pose @ box.center(), float(np.linalg.norm(box.half_width()))


def balls_apart(a: Ball | None, b: Ball | None) -> float:
    """The gap of the balls about two geometries, which have no smaller one [m]."""
    if a is None or b is None:
        return -np.inf
    return float(np.linalg.norm(a[0] - b[0])) - a[1] - b[1]


def places_of(pair: ContactPair, R: Array, t: Array) -> int:
    """How many contacts two shapes have: one of what is round, two of a capsule, else a face's."""
    shapes = (pair.alpha.shape, pair.beta.shape)
    if any(isinstance(shape, Sphere | Ellipsoid) for shape in shapes):
        return 1
    if any(isinstance(shape, Capsule) for shape in shapes):
        return 2
    return max(FEWEST, number_within(pair, R, t, DEEP))


def jacobian(
    state: DrakeState, bodies: tuple[RigidBody, RigidBody], points: tuple[Array, Array], n: Array
) -> Array:
    """J of Eq. :eq:`eq-3` along Drake's velocities, shape (4, nv), world frame.

    `bodies` and `points` (3,) [m] are alpha's and beta's; n, (3,), is the normal.
    """
    drake, plant, _, still = state
    world = plant.world_frame()
    relative = np.zeros((6, plant.num_velocities()))
    for body, point, side in zip(bodies, points, (-1.0, 1.0), strict=True):
        on_body = plant.EvalBodyPoseInWorld(still, body).inverse() @ point
        relative += side * plant.CalcJacobianSpatialVelocity(
            still, drake.JacobianWrtVariable.kV, body.body_frame(), on_body, world, world
        )
    return np.vstack([relative[3:], n @ relative[:3]])


def friction(
    state: DrakeState,
    inspector: SceneGraphInspector,
    geometries: tuple[GeometryId, GeometryId],
    slip: float,
    stiction_tolerance: float,
) -> float:
    """The friction that Drake has of two geometries at a slip [-].

    A discrete plant knows dynamic friction alone. A continuous one has static friction up to the
    tolerance and dynamic friction from ``STRIBECK`` times it on, with a smooth step between.

    Parameters
    ----------
    state : DrakeState
    inspector, geometries : object
        Drake's.
    slip, stiction_tolerance : float
        [m/s].
    """
    properties = [
        inspector.GetProximityProperties(i).GetProperty("material", "coulomb_friction")
        for i in geometries
    ]
    both = state.drake.CalcContactFrictionFromSurfaceProperties(*properties)
    mu_s, mu_d = float(both.static_friction()), float(both.dynamic_friction())
    if state.plant.time_step():
        return mu_d
    x = (slip / stiction_tolerance - 1) / (STRIBECK - 1)
    x = min(max(x, 0.0), 1.0)
    return mu_s - (mu_s - mu_d) * x**3 * (10 + x * (6 * x - 15))
