"""The contacts of a Drake plant: its geometries at their poses, as shapes of this package.

Shapes, gaps, normals and the corners of faces are the package's own. Drake's filters say which
geometries may touch, and its properties how they rub.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import ModuleType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import number_within, pair_closest_points
from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import ModelError
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
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.tolerances import DEEP, LIES_FLAT

if TYPE_CHECKING:
    from pydrake.all import Context, GeometryId, MultibodyPlant, RigidBody, SceneGraphInspector

STICTION = 1e-3
"""Slip up to which the friction of a continuous plant is static, Drake's default [m/s]."""
STRIBECK = 3.0
"""Slip over that, from which on the friction of a continuous plant is dynamic [-]."""
HULLS = ("Convex", "Mesh")
ROUND = ("Sphere", "Ellipsoid")
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


class Contact(NamedTuple):
    """One contact of two geometries.

    Parameters
    ----------
    name : str
        Its pair's; with a number where the pair has several contacts.
    pair : str
        Names of the geometries, alpha's first; with a number where another pair has the same.
    geometries : tuple
        Drake's ids of them.
    bodies : tuple
        Drake's bodies.
    phi : float
        [m].
    n : ndarray, shape (3,)
    J : ndarray, shape (4, nv)
        Of Eq. :eq:`eq-3`, along Drake's velocities.
    mu_v : float
        [-].
    flat : bool
        Whether it counts as closed, since the two are closed: it is nearer than LIES_FLAT.
    """

    name: str
    pair: str
    geometries: tuple[GeometryId, GeometryId]
    bodies: tuple[RigidBody, RigidBody]
    phi: float
    n: Array
    J: Array
    mu_v: float
    flat: bool

    def slip(self, v: Array) -> float:
        """Speed of one surface along the other at a velocity v, (nv,) [m/s]."""
        return slip_rate(self.J, self.n, v)


def slip_rate(J: Array, n: Array, v: Array) -> float:
    """Speed of one surface along the other [m/s], from J (4, nv) and a velocity v, (nv,)."""
    slip = J[:3] @ v
    return float(np.linalg.norm(slip - (n @ slip) * n))


def drake_contacts(
    state: DrakeState, margin: float, stiction_tolerance: float = STICTION
) -> list[Contact]:
    """All contacts of geometries that are nearer than the margin [m], pair by pair.

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
    v = plant.GetVelocities(context)
    discrete = bool(plant.time_step())
    near = [
        (B, A)
        for A, B in sorted(
            sorted(number[i.get_value()] for i in two) for two in inspector.GetCollisionCandidates()
        )
        if bounds_apart(inspector, (ids[A], ids[B]), (places[A], places[B])) <= margin
    ]
    names = [f"{shapes[B].name}/{shapes[A].name}" for B, A in near]
    contacts = []
    for i, (B, A) in enumerate(near):
        bodies = [plant.GetBodyFromFrameId(inspector.GetFrameId(ids[link])) for link in (B, A)]
        rubs = friction_of(drake, inspector, ids[A], ids[B])
        name = names[i] if names.count(names[i]) == 1 else f"{i}: {names[i]}"
        pair = ContactPair(name, shapes[B], shapes[A], 0.0, 0.0, rows=4, k=1)
        pair = replace(pair, k=places_of(inspector, pair, (ids[A], ids[B]), R, t))
        points = pair_closest_points(pair, R, t)
        kept = np.flatnonzero(points.phi <= margin)
        size = min(shapes[link].shape.extent for link in (A, B))
        flat = (points.phi.min() <= 0) & (points.phi <= LIES_FLAT * size)
        for k in kept.tolist():
            J = jacobian(state, bodies, (points.alpha[k], points.beta[k]), points.n[k])
            slip = slip_rate(J, points.n[k], v)
            mu_v = friction(*rubs, slip, discrete, stiction_tolerance)
            contacts.append(
                Contact(name if len(kept) == 1 else f"{name}/{points.point[k]}", name,
                        (ids[B], ids[A]), (bodies[0], bodies[1]), float(points.phi[k]),
                        points.n[k], J, mu_v, bool(flat[k]))
            )  # fmt: skip
    return contacts


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


def bounds_apart(
    inspector: SceneGraphInspector,
    ids: tuple[GeometryId, GeometryId],
    places: tuple[object, object],
) -> float:
    """A lower bound on the gap of two geometries [m], from balls about their boxes."""
    boxes = [inspector.GetObbInGeometryFrame(i) for i in ids]
    if None in boxes:  # a half-space has none
        return -np.inf
    centres = [X @ box.center() for X, box in zip(places, boxes, strict=True)]
    radii = sum(float(np.linalg.norm(box.half_width())) for box in boxes)
    return float(np.linalg.norm(centres[0] - centres[1])) - radii


def places_of(
    inspector: SceneGraphInspector, pair: ContactPair, ids: tuple[GeometryId, GeometryId],
    R: Array, t: Array,
) -> int:  # fmt: skip
    """How many contacts two shapes have: one of what is round, two of a capsule, else a face's."""
    kinds = {type(inspector.GetShape(i)).__name__ for i in ids}
    if kinds & {*ROUND}:
        return 1
    if "Capsule" in kinds:
        return 2
    return max(FEWEST, number_within(pair, R, t, DEEP))


def jacobian(
    state: DrakeState, bodies: list[RigidBody], points: tuple[Array, Array], n: Array
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


def friction_of(
    drake: ModuleType, inspector: SceneGraphInspector, A: GeometryId, B: GeometryId
) -> tuple[float, float]:
    """Static and dynamic friction of two geometries [-]."""
    properties = [
        inspector.GetProximityProperties(i).GetProperty("material", "coulomb_friction")
        for i in (A, B)
    ]
    both = drake.CalcContactFrictionFromSurfaceProperties(*properties)
    return float(both.static_friction()), float(both.dynamic_friction())


def friction(
    mu_s: float, mu_d: float, slip: float, discrete: bool, stiction_tolerance: float
) -> float:
    """The friction that Drake has at a slip [-].

    A discrete plant knows dynamic friction alone. A continuous one has static friction up to the
    tolerance and dynamic friction from ``STRIBECK`` times it on, with a smooth step between.

    Parameters
    ----------
    mu_s, mu_d : float
        Static and dynamic friction [-].
    slip, stiction_tolerance : float
        [m/s].
    discrete : bool
    """
    if discrete:
        return mu_d
    x = (slip / stiction_tolerance - 1) / (STRIBECK - 1)
    x = min(max(x, 0.0), 1.0)
    return mu_s - (mu_s - mu_d) * x**3 * (10 + x * (6 * x - 15))


def contacts(every: list[Contact], T: Array, closed: bool) -> Contacts:
    """Contacts of a step, T (nv, n_v) [-]; if `closed`, no gap below zero or of a flat corner."""
    n = np.array([contact.n for contact in every]).reshape(-1, 3)
    phi = np.array([contact.phi for contact in every])
    flat = np.array([contact.flat for contact in every], dtype=bool)
    d1, d2 = tangents(n)
    return Contacts(
        name=tuple(contact.name for contact in every),
        phi=np.where(flat, 0.0, phi) if closed else phi,
        n=n,
        d1=d1,
        d2=d2,
        J=np.array([contact.J @ T for contact in every]).reshape(-1, 4, T.shape[1]),
        mu_v=np.array([contact.mu_v for contact in every]),
        mu_omega=np.zeros(len(every)),
        rows=np.full(len(every), 4),
    )


def contact_words(every: list[Contact]) -> Iterator[str]:
    """The contacts of bodies that are deep in each other."""
    for contact in every:
        if contact.phi < -DEEP:
            depth = f"its bodies penetrate by {-1e3 * contact.phi:.3g} mm"
            yield f"contact[{contact.name}]: {depth}"
