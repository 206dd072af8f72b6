"""Signed distances, nearest points, mass matrices and Jacobians from Drake, of the same bodies."""

from importlib import import_module
from typing import Any

import numpy as np

from quasistatic_ref.contact.distance import pair_closest_points
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison
from quasistatic_ref.lab.scenes.systems import joint_text, link_text, robot_text, system_of
from quasistatic_ref.model.system import System
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.step.data import Array

POSES = 12
DISTANCE_TOLERANCE = 1e-12
"""Metres: closed forms on both sides, as one of the two shapes is a sphere."""

MATRIX_TOLERANCE = 1e-12
"""Over the largest entry: two recursions over five links, each rounded."""

SHAPES = {
    "sphere": '<sphere radius="0.05"/>',
    "box": '<box size="0.06 0.10 0.08"/>',
    "cylinder": '<cylinder radius="0.04" length="0.1"/>',
}
ARM = robot_text(
    link_text("base", 1.3, (0.02, 0.03, 0.04), com=(0.01, -0.02, 0.03)),
    link_text("upper", 0.7, (0.004, 0.003, 0.002), com=(0.1, 0.0, 0.02)),
    link_text("lower", 0.4, (0.001, 0.003, 0.0025), com=(0.0, 0.05, 0.1)),
    link_text("slider", 0.2, (0.001, 0.001, 0.0015), com=(0.02, 0.0, 0.0)),
    joint_text("swing", "revolute", "base", "upper", "0.6 0 0.8", "0.1 0.2 0.3"),
    joint_text("bend", "revolute", "upper", "lower", "0 1 0", "0 -0.1 0.2"),
    joint_text("slide", "prismatic", "lower", "slider", "0 0.8 0.6", "0.05 0 0"),
)
JOINTS = ("swing", "bend", "slide")


def drake_plant(texts: dict[str, str]) -> tuple[Any, Any, Any]:
    """Plant, diagram and scene graph of some URDF texts, one model each."""
    module = import_module("pydrake.all")
    builder = module.DiagramBuilder()
    plant, scene_graph = module.AddMultibodyPlantSceneGraph(builder, 0.0)
    for name, text in texts.items():
        parser = module.Parser(plant, name)
        # Our loader needs the version for capsules; Drake warns that it does not know it.
        parser.AddModelsFromString(text.replace(' version="1.1"', ""), "urdf")
    plant.Finalize()
    return plant, builder.Build(), scene_graph


def set_pose(plant: Any, context: Any, body: Any, R: Array, t: Array) -> None:
    """Put a free body of Drake's at a pose."""
    math = import_module("pydrake.math")
    pose = math.RigidTransform(math.RotationMatrix(R), t)
    plant.SetFreeBodyPose(context, body, pose)


def distances() -> tuple[Array, Array]:
    """(phi, alpha, beta) of every pair at every pose (k, 7) [m]: ours, Drake's."""
    rng = np.random.default_rng(6)
    ours = []
    theirs = []
    for shape in SHAPES.values():
        texts = {
            "one": robot_text(link_text("one", 1.0, (1e-3,) * 3, shape)),
            "two": robot_text(link_text("two", 1.0, (1e-3,) * 3, '<sphere radius="0.03"/>')),
        }
        system = system_of(texts)
        placed: dict[str, PlacedShape] = {s.name.split("/")[0]: s for s in system.shapes}
        pair = ContactPair("pair", placed["one"], placed["two"], 0.5, 0.0, 4, 1)
        plant, diagram, scene_graph = drake_plant(texts)
        context = diagram.CreateDefaultContext()
        within = plant.GetMyContextFromRoot(context)
        bodies = [plant.GetBodyByName(name) for name in texts]
        geometries = [plant.GetCollisionGeometriesForBody(body)[0] for body in bodies]
        for _ in range(POSES):
            spread = np.tile([0.07, 0.07, 0.07, 1.0, 1.0, 1.0], 2)
            q = system.integrate(system.q_start, rng.uniform(-1, 1, 12) * spread)
            at = system.kinematics(q)
            links = [system.link(name) for name in texts]
            for body, link in zip(bodies, links, strict=True):
                set_pose(plant, within, body, at.R[link], at.t[link])
            query = scene_graph.get_query_output_port().Eval(
                scene_graph.GetMyContextFromRoot(context)
            )
            near = query.ComputeSignedDistancePairClosestPoints(*geometries)
            points = [np.asarray(near.p_ACa), np.asarray(near.p_BCb)]
            world = [at.R[k] @ p + at.t[k] for k, p in zip(links, points, strict=True)]
            nearest = pair_closest_points(pair, at.R, at.t)
            ours.append(np.concatenate([nearest.phi, nearest.alpha[0], nearest.beta[0]]))
            theirs.append(np.concatenate([[near.distance], *world]))
    return np.array(ours), np.array(theirs)


def drake_map(system: System, q: Array, plant: Any) -> Array:
    """T (n_v, n_v) with Drake's v = T delta_q: its bases have world [omega; v], ours [v; omega]."""
    R = system.kinematics(q).R[system.link("arm")]
    T = np.zeros((system.n_v, system.n_v))
    base = plant.GetBodyByName("base").floating_velocities_start_in_v()
    at = system.joint("arm/base").v.start
    T[base : base + 3, at + 3 : at + 6] = T[base + 3 : base + 6, at : at + 3] = R
    for name in JOINTS:
        T[plant.GetJointByName(name).velocity_start(), system.joint(f"arm/{name}").v.start] = 1.0
    return T


def dynamics() -> dict[str, tuple[Array, Array]]:
    """(ours, Drake's) mass matrices and Jacobians (k, n, n_v) of a floating arm, at random q."""
    rng = np.random.default_rng(7)
    system = system_of({"arm": ARM})
    module = import_module("pydrake.all")
    plant, diagram, _ = drake_plant({"arm": ARM})
    context = plant.GetMyContextFromRoot(diagram.CreateDefaultContext())
    world = plant.world_frame()
    masses = []
    jacobians = []
    for _ in range(POSES):
        q = system.integrate(system.q_start, rng.uniform(-1, 1, system.n_v))
        at = system.kinematics(q)
        root = system.link("arm")
        set_pose(plant, context, plant.GetBodyByName("base"), at.R[root], at.t[root])
        for name in JOINTS:
            joint = plant.GetJointByName(name)
            position = float(q[system.joint(f"arm/{name}").q.start])
            set_position = "set_translation" if name == "slide" else "set_angle"
            getattr(joint, set_position)(context, position)
        T = drake_map(system, q, plant)
        masses.append((system.M_u(q), T.T @ plant.CalcMassMatrix(context) @ T))
        for name in ("base", "upper", "lower", "slider"):
            frame = plant.GetFrameByName(name)
            J = plant.CalcJacobianSpatialVelocity(
                context, module.JacobianWrtVariable.kV, frame, np.zeros(3), world, world
            )
            link = system.link(f"arm/{name}")
            jacobians.append((at.J[link], np.vstack([J[3:], J[:3]]) @ T))
    return {
        "M": (np.array([a for a, _ in masses]), np.array([b for _, b in masses])),
        "J": (np.array([a for a, _ in jacobians]), np.array([b for _, b in jacobians])),
    }


def evidence() -> Evidence:
    """Both parts."""
    ours, theirs = distances()
    matrices = dynamics()
    M = matrices["M"]
    J = matrices["J"]
    return Evidence.of(
        comparison("signed distance [m]", ours[:, 0], theirs[:, 0], DISTANCE_TOLERANCE),
        comparison("nearest points [m]", ours[:, 1:], theirs[:, 1:], DISTANCE_TOLERANCE),
        comparison("mass matrix [kg, kg m, kg m^2]", *M, MATRIX_TOLERANCE, np.abs(M[1]).max()),
        comparison("Jacobians of links [-, m]", *J, MATRIX_TOLERANCE, np.abs(J[1]).max()),
    )


CLAIM = Claim(
    name="drake",
    sentence="Drake computes the same signed distances, nearest points, mass matrices and "
    "Jacobians from the same URDFs.",
    where="Drake (pydrake), after the map of its velocities [omega; v] in world axes to our twists",
    sweep="a sphere against sphere, box and cylinder, 12 poses each; a floating arm of three "
    "joints, 12 configurations",
    reason="DISTANCE_TOLERANCE and MATRIX_TOLERANCE: closed forms and short recursions, rounded.",
    measure=evidence,
    engine="drake",
    setting="queries and kinematics, which have no settings",
)
