"""States of Drake against statics and distances by hand: faces, gaps, friction, stale outputs."""

from importlib import import_module

import numpy as np
import pytest

import quasistatic_ref as qr

pytestmark = pytest.mark.extra("drake")
GRAVITY = 9.81


class Plant:
    """A discrete plant of Drake's with solids of 1 kg on a ground, which stays alive with this."""

    def __init__(self, ground, time_step=1e-3, friction=(0.5, 0.5), gravity=(0.0, 0.0, -GRAVITY)):
        self.drake = drake = import_module("pydrake.all")
        self.builder = drake.DiagramBuilder()
        self.plant, _ = drake.AddMultibodyPlantSceneGraph(self.builder, time_step)
        self.plant.mutable_gravity_field().set_gravity_vector(gravity)
        self.rubs = drake.CoulombFriction(*friction)
        self.bodies = {}
        if ground:
            at = drake.RigidTransform([0.0, 0.0, -0.5 if ground == "box" else 0.0])
            shape = drake.Box(4.0, 4.0, 1.0) if ground == "box" else drake.HalfSpace()
            self.geometry(self.plant.world_body(), at, shape, "ground")

    def geometry(self, body, at, shape, name):
        """Give a body a geometry."""
        self.plant.RegisterCollisionGeometry(body, at, shape, name, self.rubs)

    def solid(self, name, shape, at, com=(0.0, 0.0, 0.0)):
        """A body of 1 kg, whose inertia is that of a box of 100 mm."""
        unit = self.drake.UnitInertia.SolidBox(0.1, 0.1, 0.1).ShiftFromCenterOfMass(com)
        body = self.plant.AddRigidBody(name, self.drake.SpatialInertia(1.0, com, unit))
        self.geometry(body, self.drake.RigidTransform(), shape, name)
        self.bodies[name] = body, at
        return body

    def done(self):
        """The diagram and its context, with all bodies in place."""
        self.plant.Finalize()
        self.diagram = self.builder.Build()
        self.context = self.diagram.CreateDefaultContext()
        self.own = self.plant.GetMyContextFromRoot(self.context)
        for body, at in self.bodies.values():
            self.plant.SetFreeBodyPose(self.own, body, self.drake.RigidTransform(at))
        return self

    def opinion(self, seconds=0.0, *given):
        """The opinion on the scene after some seconds."""
        self.drake.Simulator(self.diagram, self.context).AdvanceTo(seconds)
        return qr.drake_opinion(self.diagram, self.context, *given)


def wedge(folder):
    """The prism of 20 sides of radius 50 mm and height 100 mm that a mesh is."""
    turns = np.linspace(0.0, 2 * np.pi, 20, endpoint=False)
    lines = [f"v {np.cos(a) / 20} {np.sin(a) / 20} {z}" for z in (-0.05, 0.05) for a in turns]
    top = " ".join(str(21 + i) for i in range(20))
    (folder / "prism.obj").write_text("\n".join([*lines, f"f {top}"]) + "\n")
    return str(folder / "prism.obj")


SOLIDS = {
    "box": lambda drake, folder: drake.Box(0.1, 0.1, 0.1),
    "cylinder": lambda drake, folder: drake.Cylinder(0.05, 0.1),
    "prism of 20 sides": lambda drake, folder: drake.Convex(wedge(folder), 1.0),
}


@pytest.mark.parametrize("com", [(0.0, 0.0, 0.0), (0.02, 0.01, 0.0)])
@pytest.mark.parametrize("ground", ["box", "half-space"])
@pytest.mark.parametrize("solid", SOLIDS)
def test_what_stands_on_a_face_stands(solid, ground, com, tmp_path):
    """Its weight by hand, at corners all around; in Drake it rocks on one contact."""
    scene = Plant(ground)
    scene.solid("solid", SOLIDS[solid](scene.drake, tmp_path), [0.0, 0.0, 0.05 - 1e-6], com)
    opinion = scene.done().opinion(1.0)
    assert opinion.findings == ()
    (contact,) = opinion.contacts
    assert contact.exact.normal == pytest.approx(GRAVITY, rel=1e-6)
    assert opinion.bodies[0].exact.speed == pytest.approx(0.0, abs=1e-9)


def test_flat_pads_hold_a_box_whose_centre_of_mass_is_beside_them():
    """20 N each; the torque of 1 kg at 5 mm is borne by the faces, without torsional friction."""
    scene = Plant(None, friction=(0.8, 0.8))
    drake, plant = scene.drake, scene.plant
    for side, name in ((-1, "left"), (1, "right")):
        inertia = drake.SpatialInertia.SolidBoxWithMass(0.05, 0.02, 0.02, 0.02)
        pad = plant.AddRigidBody(name, inertia)
        axis = [-side, 0, 0]
        joint = drake.PrismaticJoint(f"to {name}", plant.world_frame(), pad.body_frame(), axis)
        plant.AddJointActuator(name, plant.AddJoint(joint))
        at = drake.RigidTransform([side * 0.03, 0, 0])
        scene.geometry(pad, at, drake.Box(0.02, 0.04, 0.04), name)
    scene.solid("part", drake.Box(0.04, 0.04, 0.04), [0.0, 0.0, 0.003], (0.0, 0.005, 0.0))
    rails = ("to left", "to right")
    opinion = scene.done().opinion(0.0, dict.fromkeys(rails, 1e4), dict.fromkeys(rails, 0.002))
    assert opinion.findings == ()
    assert [c.exact.normal for c in opinion.contacts] == pytest.approx([20.0, 20.0])


def test_a_discrete_plant_knows_dynamic_friction_alone():
    """On a slope of tangent 0.5, as Drake does: it slides; 0.2 holds 0.4 of the load."""
    slope = np.arctan(0.5)
    gravity = GRAVITY * np.array([np.sin(slope), 0.0, -np.cos(slope)])
    scene = Plant("half-space", friction=(1.0, 0.2), gravity=gravity)
    sled = scene.solid("sled", scene.drake.Sphere(0.01), [0.0, 0.0, 0.01], (0.05, 0.05, 0.01))
    for x, y in ((0.1, 0.0), (0.0, 0.1), (0.1, 0.1)):
        at = scene.drake.RigidTransform([x, y, 0.0])
        scene.geometry(sled, at, scene.drake.Sphere(0.01), f"foot {x} {y}")
    opinion = scene.done().opinion(1.0)
    speed = GRAVITY * (np.sin(slope) - 0.2 * np.cos(slope))
    assert scene.plant.GetVelocities(scene.own)[3] == pytest.approx(speed, rel=0.01)
    (finding,) = opinion.findings
    assert finding.name == "slides"
    assert finding.numbers["share"] == pytest.approx(0.4, rel=0.06)
    assert [contact.mu_v for contact in opinion.contacts] == pytest.approx([0.2] * 4)


@pytest.mark.parametrize(
    ("slip", "mu"), [(0.0, 1.0), (0.9e-3, 1.0), (2e-3, 0.6), (3e-3, 0.2), (1.0, 0.2)]
)
def test_a_continuous_plant_has_static_friction_up_to_its_stiction_tolerance(slip, mu):
    """And dynamic friction from three times that on, with a step between: half at twice it."""
    scene = Plant("half-space", time_step=0.0, friction=(1.0, 0.2))
    body = scene.solid("ball", scene.drake.Sphere(0.1), [0.0, 0.0, 0.1])
    scene.done()
    rolls = scene.drake.SpatialVelocity([0.0, 0.0, 0.0], [slip, 0.0, 0.0])
    scene.plant.SetFreeBodySpatialVelocity(scene.own, body, rolls)
    step, _ = qr.drake_step(scene.plant, scene.own, 1e-3, {})
    assert step.contacts.mu_v == pytest.approx([mu])
    stricter, _ = qr.drake_step(scene.plant, scene.own, 1e-3, {}, stiction_tolerance=1e-4)
    assert stricter.contacts.mu_v == pytest.approx([0.2 if slip else 1.0])


def test_forces_are_those_of_the_state_and_not_of_the_step_before():
    """A ball that rests, and is then lifted, pressed down, or pulled away by hand."""
    scene = Plant("half-space")
    body = scene.solid("ball", scene.drake.Sphere(0.1), [0.0, 0.0, 0.0999])
    (first,) = scene.done().opinion(0.0).contacts
    assert first.theirs.normal > 0
    (contact,) = scene.opinion(1.0).contacts
    assert contact.theirs.normal == pytest.approx(GRAVITY, rel=1e-3)

    def moved_to(z, speed=0.0):
        scene.plant.SetFreeBodyPose(scene.own, body, scene.drake.RigidTransform([0.0, 0.0, z]))
        up = scene.drake.SpatialVelocity([0.0, 0.0, 0.0], [0.0, 0.0, speed])
        scene.plant.SetFreeBodySpatialVelocity(scene.own, body, up)
        return qr.drake_opinion(scene.diagram, scene.context)

    lifted = moved_to(0.15)
    assert (lifted.contacts, lifted.findings) == ((), ())
    (pressed,) = moved_to(0.098).contacts
    assert (pressed.depth, pressed.exact.normal) == pytest.approx((0.002, GRAVITY))
    assert pressed.theirs.normal > 2 * GRAVITY
    (leaving,) = moved_to(0.0999, 1.0).contacts
    assert leaving.theirs.normal == pytest.approx(0.0, abs=1e-6)


GAPS = {
    "crossed cylinders": (
        lambda drake: drake.Cylinder(0.05, 0.4), [1.0, 0.0, 0.0],
        lambda drake: drake.Cylinder(0.03, 0.4), [0.0, 0.0, 0.081],
    ),
    "an ellipsoid over a cylinder": (
        lambda drake: drake.Cylinder(0.05, 0.2), [0.0, 0.0, 1.0],
        lambda drake: drake.Ellipsoid(0.02, 0.03, 0.04), [0.01, 0.02, 0.141],
    ),
    "a capsule along a cylinder": (
        lambda drake: drake.Cylinder(0.05, 0.2), [0.0, 0.0, 1.0],
        lambda drake: drake.Capsule(0.02, 0.1), [0.071, 0.0, 0.0],
    ),
}  # fmt: skip


@pytest.mark.parametrize("two", GAPS)
def test_gaps_of_curved_shapes_are_1_mm(two):
    """By hand: distances of axes and heights, less radii."""
    first, axis, second, at = GAPS[two]
    scene = Plant(None, time_step=0.0)
    turned = scene.drake.RotationMatrix.MakeFromOneVector(axis, 2)
    place = scene.drake.RigidTransform(turned, [0.0, 0.0, 0.0])
    scene.geometry(scene.plant.world_body(), place, first(scene.drake), "first")
    body = scene.solid("second", second(scene.drake), at)
    scene.done()
    if two == "crossed cylinders":
        turned = scene.drake.RotationMatrix.MakeFromOneVector([0.6, 0.8, 0.0], 2)
        scene.plant.SetFreeBodyPose(scene.own, body, scene.drake.RigidTransform(turned, at))
    step, coordinates = qr.drake_step(scene.plant, scene.own, 0.01, {})
    assert step.contacts.phi.min() == pytest.approx(0.001, abs=1e-9)
    assert coordinates.left_out == ()


def test_a_surface_of_contact_counts_by_its_force():
    """A soft box on a hydroelastic floor: its weight by hand, in both answers."""
    scene = Plant(None)
    drake, plant = scene.drake, scene.plant
    plant.set_contact_model(drake.ContactModel.kHydroelastic)
    soft = drake.ProximityProperties()
    drake.AddContactMaterial(None, None, scene.rubs, soft)
    hard = drake.ProximityProperties(soft)
    drake.AddCompliantHydroelasticProperties(0.05, 1e6, soft)
    drake.AddRigidHydroelasticProperties(0.5, hard)
    scene.rubs = hard
    at = drake.RigidTransform([0.0, 0.0, -0.5])
    scene.geometry(plant.world_body(), at, drake.Box(1.0, 1.0, 1.0), "ground")
    scene.rubs = soft
    scene.solid("box", drake.Box(0.1, 0.1, 0.1), [0.0, 0.0, 0.0499])
    opinion = scene.done().opinion(2.0)
    (contact,) = opinion.contacts
    assert contact.theirs.normal == pytest.approx(GRAVITY, rel=0.01)
    assert contact.exact.normal == pytest.approx(GRAVITY, rel=1e-6)
    assert opinion.findings == ()
