"""What Drake has, and what becomes of it; opinions on Drake's states, by statics on a slope."""

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


def block_on_floor(change=lambda drake, plant, body: None, mu=0.5, slope=0.0, free=True):
    """A block of 1 kg on four feet on a floor, or on a rail above it: diagram, plant, context."""
    drake = import_module("pydrake.all")
    builder = drake.DiagramBuilder()
    plant, _ = drake.AddMultibodyPlantSceneGraph(builder, 1e-3)
    plant.set_discrete_contact_approximation(drake.DiscreteContactApproximation.kLagged)
    block = drake.SpatialInertia.SolidBoxWithMass(1.0, 0.2, 0.2, 0.1)
    body = plant.AddRigidBody("block", block)
    rubs = drake.CoulombFriction(mu, mu)
    for i, (x, y) in enumerate([(-0.1, -0.1), (-0.1, 0.1), (0.1, -0.1), (0.1, 0.1)]):
        at = drake.RigidTransform([x, y, -0.04])
        plant.RegisterCollisionGeometry(body, at, drake.Sphere(0.01), f"foot{i}", rubs)
    here = drake.RigidTransform()
    world = plant.world_body()
    plant.RegisterCollisionGeometry(world, here, drake.HalfSpace(), "floor", rubs)
    down = GRAVITY * np.array([np.sin(slope), 0.0, -np.cos(slope)])
    plant.mutable_gravity_field().set_gravity_vector(down)
    if not free:
        rail = drake.PrismaticJoint("rail", plant.world_frame(), body.body_frame(), [1, 0, 0])
        plant.AddJointActuator("motor", plant.AddJoint(rail), 5.0)
    then = change(drake, plant, body)
    plant.Finalize()
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    of_plant = plant.GetMyContextFromRoot(context)
    if free:
        plant.SetFreeBodyPose(of_plant, body, drake.RigidTransform([0, 0, 0.05]))
    if then is not None:
        then(of_plant)
    return diagram, plant, context


def opinion_on_block(seconds=1.0, **given):
    """The opinion on a block that has settled for some seconds."""
    diagram, _, context = block_on_floor(**given)
    import_module("pydrake.all").Simulator(diagram, context).AdvanceTo(seconds)
    return qr.drake_opinion(diagram, context)


def test_a_block_that_rests_has_no_finding():
    opinion = opinion_on_block()
    assert opinion.findings == ()
    assert [c.exact.normal for c in opinion.contacts if c.exact] == pytest.approx([GRAVITY / 4] * 4)
    assert [c.theirs.normal for c in opinion.contacts] == pytest.approx([GRAVITY / 4] * 4)
    Draft4Validator(opinion_schema()).validate(json.loads(json_text(opinion.record)))
    assert "Drake's numbers" in str(opinion)


def test_contacts_of_one_name_have_numbers():
    """Two balls, of 2 and 3 kg, have a geometry of the same name: each bears its own weight."""

    def balls(drake, plant, body):
        rubs = drake.CoulombFriction(0.5, 0.5)
        here = drake.RigidTransform()
        made = []
        for mass in (2.0, 3.0):
            inertia = drake.SpatialInertia.SolidSphereWithMass(mass, 0.01)
            ball = plant.AddRigidBody(f"{mass:.0f} kg", inertia)
            plant.RegisterCollisionGeometry(ball, here, drake.Sphere(0.01), "tip", rubs)
            made.append((ball, drake.RigidTransform([mass, 0.0, 0.00999])))
        return lambda own: [plant.SetFreeBodyPose(own, *placed) for placed in made]

    contacts = opinion_on_block(change=balls).contacts
    assert len({contact.name for contact in contacts}) == len(contacts) == 6
    normals = {contact.bodies[0]: contact.exact.normal for contact in contacts if contact.exact}
    for mass in (2.0, 3.0):
        assert normals[f"{mass:.0f} kg"] == pytest.approx(mass * GRAVITY)


def test_drakes_friction_creeps_with_its_stiction_tolerance():
    def soft(drake, plant, body):
        plant.set_stiction_tolerance(0.05)

    (finding,) = opinion_on_block(2.0, slope=SLOPE, change=soft).findings
    assert finding.name == "creeps"
    assert finding.numbers == {"slip_mm_s": pytest.approx(50 * np.tan(SLOPE) / 0.5, rel=0.5)}
    assert "set_stiction_tolerance" in finding.remedy


def test_each_thing_that_drake_has_is_said_to_be_used_without_effect_or_refused():
    drake = import_module("pydrake.all")
    named = Counter(" ".join(FATES.values()).split())
    assert set(named.values()) == {1}
    kinds = (drake.Joint, drake.ForceElement, drake.Shape)
    classes = [c for c in vars(drake).values() if inspect.isclass(c) and issubclass(c, kinds)]
    _, plant, _ = block_on_floor()
    ports = [plant.get_input_port(i).get_name() for i in range(plant.num_input_ports())]
    has = {c.__name__.partition("_")[0] for c in classes if c not in kinds}
    has |= {name.rpartition("ModelInstance_")[2] for name in ports}
    assert has <= set(named)


def rail(plant):
    return plant.GetJointByName("rail")


def gains(drake, plant, body):
    plant.GetJointActuatorByName("motor").set_controller_gains(drake.PdControllerGains(p=9.0))


WITHOUT_EFFECT = {
    "velocity": lambda d, p, b: lambda own: rail(p).set_translation_rate(own, 0.3),
    "joint.damping": lambda d, p, b: rail(p).set_default_damping(3.0),
    "joint.velocity_limits": lambda d, p, b: rail(p).set_velocity_limits([-1], [1]),
    "joint.acceleration_limits": lambda d, p, b: rail(p).set_acceleration_limits([-1], [1]),
    "actuator.controller_gains": gains,
    "contact_model": lambda d, p, b: p.set_contact_model(d.ContactModel.kPoint),
    "discrete_contact_approximation": lambda d, p, b: p.set_discrete_contact_approximation(
        d.DiscreteContactApproximation.kSap
    ),
    "stiction_tolerance": lambda d, p, b: p.set_stiction_tolerance(0.1),
    "penetration_allowance": lambda d, p, b: p.set_penetration_allowance(0.1),
}
USED = {
    "joint.position_limits": lambda d, p, b: rail(p).set_position_limits([-1], [1]),
    "actuator.rotor_inertia": lambda d, p, b: (
        p.GetJointActuatorByName("motor").set_default_rotor_inertia(0.1)
        or p.GetJointActuatorByName("motor").set_default_gear_ratio(3.0)
    ),
    "PrismaticSpring": lambda d, p, b: p.AddForceElement(d.PrismaticSpring(rail(p), 0.1, 9.0)),
    "actuation": lambda d, p, b: lambda own: p.get_actuation_input_port().FixValue(own, [2.0]),
    "applied_generalized_force": lambda d, p, b: (
        lambda own: p.get_applied_generalized_force_input_port().FixValue(own, [2.0])
    ),
}


@pytest.mark.parametrize("what", [*WITHOUT_EFFECT, *USED])
def test_what_is_used_changes_the_step_and_what_is_without_effect_does_not(what):
    def step(change):
        keeps = []

        def of(drake, plant, body):
            then = change(drake, plant, body)
            keeps.append(then)
            return then if inspect.isfunction(then) else None

        _, plant, context = block_on_floor(of, free=False)
        return step_sha256(qr.drake_step(plant, plant.GetMyContextFromRoot(context), 0.01, {})[0])

    change = {**WITHOUT_EFFECT, **USED}[what]
    assert (step(change) == step(lambda d, p, b: None)) == (what in WITHOUT_EFFECT)
    assert what in FATES["used" if what in USED else "without effect"].split()


def add_planar_body(drake, plant, body):
    other = plant.AddRigidBody("other", drake.SpatialInertia.SolidSphereWithMass(1.0, 0.1))
    joint = drake.PlanarJoint("plane", plant.world_frame(), other.body_frame(), [0, 0, 0])
    plant.AddJoint(joint).set_position_limits([-1] * 3, [1] * 3)


def push_body(drake, plant, body):
    force = drake.ExternallyAppliedSpatialForce()
    force.body_index = body.index()
    return lambda own: plant.get_applied_spatial_force_input_port().FixValue(
        own, drake.Value[list[drake.ExternallyAppliedSpatialForce]]([force])
    )


def sprung(drake, plant, body):
    world = plant.world_body()
    plant.AddForceElement(drake.LinearSpringDamper(world, [0] * 3, body, [0] * 3, 1.0, 9.0, 1.0))


def hold_body(drake, plant, body):
    plant.set_discrete_contact_approximation(drake.DiscreteContactApproximation.kSap)
    plant.AddBallConstraint(plant.world_body(), [0] * 3, body, [0] * 3)


REFUSED = {
    "limits_of_several_coordinates": ({"change": add_planar_body}, "limits of several coordinates"),
    "applied_spatial_force": ({"change": push_body}, "applied_spatial_force"),
    "LinearSpringDamper": ({"change": sprung}, "LinearSpringDamper"),
    "constraints": ({"change": hold_body}, "constraints"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_no_step_can_say_is_refused_by_name(what):
    given, says = REFUSED[what]
    diagram, _, context = block_on_floor(**given)
    with pytest.raises(qr.ModelError, match=says):
        qr.drake_opinion(diagram, context)


def test_another_number_of_plants_and_a_speed_of_zero_are_refused():
    diagram, _, context = block_on_floor()
    with pytest.raises(qr.InputError, match="tolerance"):
        qr.drake_opinion(diagram, context, tolerance=0.0)
    drake = import_module("pydrake.all")
    with pytest.raises(qr.ModelError, match="one plant"):
        qr.drake_opinion(drake.DiagramBuilder(), context)
