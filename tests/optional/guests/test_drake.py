"""States of Drake against statics and distances by hand, and what becomes of each thing it has."""

import inspect
import json
from collections import Counter
from importlib import import_module

import numpy as np
import pytest
from jsonschema import Draft4Validator

import quasistatic_ref as qr
from quasistatic_ref.formats.files import json_text
from quasistatic_ref.lab.commands.schema import opinion_schema
from quasistatic_ref.optional.guests.drake import FATES
from quasistatic_ref.step.files import step_sha256

pytestmark = pytest.mark.extra("drake")
GRAVITY = 9.81
SLOPE = np.radians(15)


class Plant:
    """A plant of Drake's with solids on a ground, which stays alive with this."""

    def __init__(self, ground=None, time_step=1e-3, friction=(0.5, 0.5), slope=0.0):
        self.drake = drake = import_module("pydrake.all")
        self.builder = drake.DiagramBuilder()
        self.plant, _ = drake.AddMultibodyPlantSceneGraph(self.builder, time_step)
        down = GRAVITY * np.array([np.sin(slope), 0.0, -np.cos(slope)])
        self.plant.mutable_gravity_field().set_gravity_vector(down)
        self.rubs = drake.CoulombFriction(*friction)
        self.bodies = {}
        if ground:
            at = [0.0, 0.0, -0.5 if ground == "box" else 0.0]
            shape = drake.Box(4.0, 4.0, 1.0) if ground == "box" else drake.HalfSpace()
            self.geometry(self.plant.world_body(), at, shape, "ground")

    def geometry(self, body, at, shape, name):
        """Give a body a geometry at a point, or at a pose."""
        pose = at if isinstance(at, self.drake.RigidTransform) else self.drake.RigidTransform(at)
        self.plant.RegisterCollisionGeometry(body, pose, shape, name, self.rubs)

    def body(self, name, com=(0.0, 0.0, 0.0), mass=1.0):
        """A body whose inertia is that of a box of 100 mm."""
        unit = self.drake.UnitInertia.SolidBox(0.1, 0.1, 0.1).ShiftFromCenterOfMass(com)
        return self.plant.AddRigidBody(name, self.drake.SpatialInertia(mass, com, unit))

    def solid(self, name, shape, at, com=(0.0, 0.0, 0.0), mass=1.0):
        """A body that is free, of one geometry."""
        body = self.body(name, com, mass)
        self.geometry(body, [0.0, 0.0, 0.0], shape, "solid")
        self.bodies[name] = body, at
        return body

    def on_feet(self):
        """A body on four balls, its centre of mass 20 mm above the ground in their middle."""
        body = self.solid("sled", self.drake.Sphere(0.01), [0.0, 0.0, 0.01], (0.05, 0.05, 0.01))
        for x, y in ((0.1, 0.0), (0.0, 0.1), (0.1, 0.1)):
            self.geometry(body, [x, y, 0.0], self.drake.Sphere(0.01), f"foot {x} {y}")
        return body

    def slide(self, name, body, axis):
        """A joint with a motor, along which a body slides."""
        world = self.plant.world_frame()
        joint = self.drake.PrismaticJoint(name, world, body.body_frame(), axis)
        self.plant.AddJointActuator(name, self.plant.AddJoint(joint), 5.0)

    def done(self):
        """The diagram and its context, with all bodies in place."""
        self.plant.Finalize()
        self.diagram = self.builder.Build()
        self.context = self.diagram.CreateDefaultContext()
        self.own = self.plant.GetMyContextFromRoot(self.context)
        for body, at in self.bodies.values():
            self.plant.SetFreeBodyPose(self.own, body, self.drake.RigidTransform(at))
        return self

    def step(self, **settings):
        """The step of the state."""
        return qr.drake_step(self.plant, self.own, 0.01, {}, **settings)

    def opinion(self, seconds=0.0, *given):
        """The opinion on the scene after some seconds."""
        self.drake.Simulator(self.diagram, self.context).AdvanceTo(seconds)
        return qr.drake_opinion(self.diagram, self.context, *given)


def test_a_body_that_rests_on_feet_has_no_finding():
    scene = Plant("half-space")
    scene.on_feet()
    opinion = scene.done().opinion(1.0)
    assert opinion.findings == ()
    assert [c.exact.normal for c in opinion.contacts if c.exact] == pytest.approx([GRAVITY / 4] * 4)
    assert [c.theirs.normal for c in opinion.contacts] == pytest.approx([GRAVITY / 4] * 4)
    Draft4Validator(opinion_schema()).validate(json.loads(json_text(opinion.record)))
    assert "Drake's numbers" in str(opinion)


def test_contacts_of_one_name_have_numbers():
    """Two balls, of 2 and 3 kg, have a geometry of the same name: each bears its own weight."""
    scene = Plant("half-space")
    for mass in (2.0, 3.0):
        scene.solid(str(mass), scene.drake.Sphere(0.01), [mass, 0.0, 0.00999], mass=mass)
    contacts = scene.done().opinion(0.5).contacts
    assert len({contact.name for contact in contacts}) == len(contacts) == 2
    for contact in contacts:
        assert contact.exact.normal == pytest.approx(float(contact.bodies[0]) * GRAVITY)


def test_drakes_friction_creeps_with_its_stiction_tolerance():
    scene = Plant("half-space", slope=SLOPE)
    lagged = scene.drake.DiscreteContactApproximation.kLagged
    scene.plant.set_discrete_contact_approximation(lagged)
    scene.plant.set_stiction_tolerance(0.05)
    scene.on_feet()
    (finding,) = scene.done().opinion(2.0).findings
    assert finding.name == "creeps"
    assert finding.numbers == {"slip_mm_s": pytest.approx(50 * np.tan(SLOPE) / 0.5, rel=0.5)}
    assert "set_stiction_tolerance" in finding.remedy


def test_each_thing_that_drake_has_is_said_to_be_used_without_effect_or_refused():
    drake = import_module("pydrake.all")
    named = Counter(" ".join(FATES.values()).split())
    assert set(named.values()) == {1}
    kinds = (drake.Joint, drake.ForceElement, drake.Shape)
    classes = [c for c in vars(drake).values() if inspect.isclass(c) and issubclass(c, kinds)]
    plant = Plant().done().plant
    ports = [plant.get_input_port(i).get_name() for i in range(plant.num_input_ports())]
    has = {c.__name__.partition("_")[0] for c in classes if c not in kinds}
    has |= {name.rpartition("ModelInstance_")[2] for name in ports}
    assert has <= set(named)


def on_rail(change=None, then=None):
    """A body on a rail with a motor; a change is made before it is finished, or then."""
    scene = Plant()
    scene.slide("rail", scene.body("block"), [1, 0, 0])
    rail, motor = (
        scene.plant.GetJointByName("rail"),
        scene.plant.GetJointActuatorByName("rail"),
    )
    if change:
        change(scene, rail, motor)
    scene.done()
    if then:
        then(scene, rail, scene.own)
    return scene


def gains(scene, rail, motor):
    motor.set_controller_gains(scene.drake.PdControllerGains(p=9.0))


def rotor(scene, rail, motor):
    motor.set_default_rotor_inertia(0.1)
    motor.set_default_gear_ratio(3.0)


def spring(scene, rail, motor):
    scene.plant.AddForceElement(scene.drake.PrismaticSpring(rail, 0.1, 9.0))


WITHOUT_EFFECT = {
    "velocity": {"then": lambda scene, rail, own: rail.set_translation_rate(own, 0.3)},
    "joint.damping": {"change": lambda scene, rail, motor: rail.set_default_damping(3.0)},
    "actuator.controller_gains": {"change": gains},
}
USED = {
    "joint.position_limits": {"change": lambda s, rail, motor: rail.set_position_limits([-1], [1])},
    "actuator.rotor_inertia": {"change": rotor},
    "PrismaticSpring": {"change": spring},
    "actuation": {
        "then": lambda s, rail, own: s.plant.get_actuation_input_port().FixValue(own, [2.0])
    },
    "applied_generalized_force": {
        "then": lambda s, rail, own: s.plant.get_applied_generalized_force_input_port().FixValue(
            own, [2.0]
        )
    },
}


@pytest.mark.parametrize("what", [*WITHOUT_EFFECT, *USED])
def test_what_is_used_changes_the_step_and_what_is_without_effect_does_not(what):
    changed = on_rail(**{**WITHOUT_EFFECT, **USED}[what])
    same = step_sha256(changed.step()[0]) == step_sha256(on_rail().step()[0])
    assert same == (what in WITHOUT_EFFECT)
    assert what in FATES["used" if what in USED else "without effect"].split()


def planar(scene, rail, motor):
    world = scene.plant.world_frame()
    joint = scene.drake.PlanarJoint("plane", world, scene.body("other").body_frame(), [0, 0, 0])
    scene.plant.AddJoint(joint).set_position_limits([-1] * 3, [1] * 3)


def damper(scene, rail, motor):
    ends = scene.plant.world_body(), [0] * 3, rail.child_body(), [0] * 3
    scene.plant.AddForceElement(scene.drake.LinearSpringDamper(*ends, 1.0, 9.0, 1.0))


def constraint(scene, rail, motor):
    scene.plant.set_discrete_contact_approximation(scene.drake.DiscreteContactApproximation.kSap)
    scene.plant.AddBallConstraint(scene.plant.world_body(), [0] * 3, rail.child_body(), [0] * 3)


def push(scene, rail, own):
    force = scene.drake.ExternallyAppliedSpatialForce()
    force.body_index = rail.child_body().index()
    value = scene.drake.Value[list[scene.drake.ExternallyAppliedSpatialForce]]([force])
    scene.plant.get_applied_spatial_force_input_port().FixValue(own, value)


REFUSED = {
    "limits of several coordinates": {"change": planar},
    "applied_spatial_force": {"then": push},
    "LinearSpringDamper": {"change": damper},
    "constraints": {"change": constraint},
}


@pytest.mark.parametrize("words", REFUSED)
def test_what_no_step_can_say_is_refused_by_name(words):
    scene = on_rail(**REFUSED[words])
    with pytest.raises(qr.ModelError, match=words):
        qr.drake_opinion(scene.diagram, scene.context)


def test_another_number_of_plants_and_a_speed_of_zero_are_refused():
    scene = on_rail()
    with pytest.raises(qr.InputError, match="tolerance"):
        qr.drake_opinion(scene.diagram, scene.context, tolerance=0.0)
    with pytest.raises(qr.ModelError, match="one plant"):
        qr.drake_opinion(scene.drake.DiagramBuilder(), scene.context)


def prism(folder):
    """The file of a prism of 20 sides of radius 50 mm and height 100 mm."""
    turns = np.linspace(0.0, 2 * np.pi, 20, endpoint=False)
    lines = [f"v {np.cos(a) / 20} {np.sin(a) / 20} {z}" for z in (-0.05, 0.05) for a in turns]
    top = " ".join(str(21 + i) for i in range(20))
    (folder / "prism.obj").write_text("\n".join([*lines, f"f {top}"]) + "\n")
    return str(folder / "prism.obj")


SOLIDS = {
    "box": lambda drake, folder: drake.Box(0.1, 0.1, 0.1),
    "cylinder": lambda drake, folder: drake.Cylinder(0.05, 0.1),
    "prism of 20 sides": lambda drake, folder: drake.Convex(prism(folder), 1.0),
}


@pytest.mark.parametrize("ground", ["box", "half-space"])
@pytest.mark.parametrize("solid", SOLIDS)
def test_what_stands_on_a_face_stands(solid, ground, tmp_path):
    """Its weight by hand, at corners all around; in Drake it rocks on one contact."""
    scene = Plant(ground)
    shape = SOLIDS[solid](scene.drake, tmp_path)
    scene.solid("solid", shape, [0.0, 0.0, 0.05 - 1e-6], (0.02, 0.01, 0.0))
    opinion = scene.done().opinion(1.0)
    assert opinion.findings == ()
    (contact,) = opinion.contacts
    assert contact.exact.normal == pytest.approx(GRAVITY, rel=1e-6)
    assert opinion.bodies[0].exact.speed == pytest.approx(0.0, abs=1e-9)


def test_flat_pads_hold_a_box_whose_centre_of_mass_is_beside_them():
    """20 N each; the torque of 1 kg at 5 mm is borne by the faces, without torsional friction."""
    scene = Plant(friction=(0.8, 0.8))
    for side, name in ((-1, "left"), (1, "right")):
        pad = scene.body(name, mass=0.05)
        scene.slide(name, pad, [-side, 0, 0])
        scene.geometry(pad, [side * 0.03, 0, 0], scene.drake.Box(0.02, 0.04, 0.04), name)
    scene.solid("part", scene.drake.Box(0.04, 0.04, 0.04), [0.0, 0.0, 0.003], (0.0, 0.005, 0.0))
    rails = ("left", "right")
    opinion = scene.done().opinion(0.0, dict.fromkeys(rails, 1e4), dict.fromkeys(rails, 0.002))
    assert opinion.findings == ()
    assert [c.exact.normal for c in opinion.contacts] == pytest.approx([20.0, 20.0])


def test_a_discrete_plant_knows_dynamic_friction_alone():
    """On a slope of tangent 0.5, as Drake does: it slides; 0.2 holds 0.4 of the load."""
    slope = np.arctan(0.5)
    scene = Plant("half-space", friction=(1.0, 0.2), slope=slope)
    scene.on_feet()
    opinion = scene.done().opinion(1.0)
    speed = GRAVITY * (np.sin(slope) - 0.2 * np.cos(slope))
    assert scene.plant.GetVelocities(scene.own)[3] == pytest.approx(speed, rel=0.01)
    (finding,) = opinion.findings
    assert finding.name == "slides"
    assert finding.numbers["share"] == pytest.approx(0.4, rel=0.06)
    assert [contact.mu_v for contact in opinion.contacts] == pytest.approx([0.2] * 4)


@pytest.mark.parametrize(("slip", "mu"), [(0.9e-3, 1.0), (2e-3, 0.6), (3e-3, 0.2)])
def test_a_continuous_plant_has_static_friction_up_to_its_stiction_tolerance(slip, mu):
    """And dynamic friction from three times that on, with a step between: half at twice it."""
    scene = Plant("half-space", time_step=0.0, friction=(1.0, 0.2))
    body = scene.solid("ball", scene.drake.Sphere(0.1), [0.0, 0.0, 0.1])
    scene.done()
    slides = scene.drake.SpatialVelocity([0.0, 0.0, 0.0], [slip, 0.0, 0.0])
    scene.plant.SetFreeBodySpatialVelocity(scene.own, body, slides)
    assert scene.step()[0].contacts.mu_v == pytest.approx([mu])
    assert scene.step(stiction_tolerance=1e-4)[0].contacts.mu_v == pytest.approx([0.2])
    with pytest.raises(qr.InputError, match="stiction_tolerance: must be a positive speed"):
        scene.step(stiction_tolerance=0.0)


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
    scene = Plant(time_step=0.0)
    turned = scene.drake.RotationMatrix.MakeFromOneVector(axis, 2)
    place = scene.drake.RigidTransform(turned, [0.0, 0.0, 0.0])
    scene.geometry(scene.plant.world_body(), place, first(scene.drake), "first")
    body = scene.solid("second", second(scene.drake), at)
    scene.done()
    if two == "crossed cylinders":
        turned = scene.drake.RotationMatrix.MakeFromOneVector([0.6, 0.8, 0.0], 2)
        scene.plant.SetFreeBodyPose(scene.own, body, scene.drake.RigidTransform(turned, at))
    step, coordinates = scene.step()
    assert step.contacts.phi.min() == pytest.approx(0.001, abs=1e-9)
    assert coordinates.left_out == ()


def test_a_surface_of_contact_counts_by_its_force():
    """A soft box on a hydroelastic floor: its weight by hand, in both answers."""
    scene = Plant()
    drake = scene.drake
    scene.plant.set_contact_model(drake.ContactModel.kHydroelastic)
    soft = drake.ProximityProperties()
    drake.AddContactMaterial(None, None, scene.rubs, soft)
    hard = drake.ProximityProperties(soft)
    drake.AddCompliantHydroelasticProperties(0.05, 1e6, soft)
    drake.AddRigidHydroelasticProperties(0.5, hard)
    scene.rubs = hard
    scene.geometry(scene.plant.world_body(), [0, 0, -0.5], drake.Box(1.0, 1.0, 1.0), "ground")
    scene.rubs = soft
    scene.solid("box", drake.Box(0.1, 0.1, 0.1), [0.0, 0.0, 0.0499])
    opinion = scene.done().opinion(2.0)
    (contact,) = opinion.contacts
    assert contact.theirs.normal == pytest.approx(GRAVITY, rel=0.01)
    assert contact.exact.normal == pytest.approx(GRAVITY, rel=1e-6)
    assert opinion.findings == ()
