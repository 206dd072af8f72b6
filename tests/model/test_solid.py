"""Bodies without a file: solids with the inertia of their volume, URDF as text."""

import coal
import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    ModelError,
    Sphere,
    System,
)
from tests.cases import cases, refusal
from tests.closeness import assert_same, assert_within
from tests.scenes import BALL
from tests.tolerances import ROUNDING

MASS = 0.7


SOLIDS = {
    "sphere": (Sphere(0.03), coal.Sphere(0.03)),
    "cylinder": (Cylinder(0.03, 0.05), coal.Cylinder(0.03, 0.1)),
    "capsule": (Capsule(0.03, 0.05), coal.Capsule(0.03, 0.1)),
    "box": (Box((0.1, 0.2, 0.3)), coal.Box(0.2, 0.4, 0.6)),
}


@cases("shape, solid", SOLIDS)
def test_a_body_of_a_shape_is_a_free_solid_about_its_centre(shape, solid):
    """Its moments of inertia are those of coal, whose solids have a density of one."""
    system = System([Body.of_shape("it", shape, MASS, xyz=(1, 2, 3), rpy=(0.1, 0.2, 0.3))])
    expected = MASS * np.eye(6)
    expected[3:, 3:] = MASS / solid.computeVolume() * solid.computeMomentofInertia()
    assert_within(system.M_u(system.q_start), expected, ROUNDING * MASS)
    (placed,) = system.shapes
    assert placed.name == "it/solid#0"
    assert repr(placed.shape) == repr(shape)  # to the last bit
    assert_same(placed.R, np.eye(3))
    assert_same(placed.t, np.zeros(3))
    assert_same(system.q_start[:3], [1, 2, 3])
    assert (system.n_a, system.n_u) == (0, 6)


def test_a_solid_may_be_driven_fixed_or_planar():
    ball = Sphere(0.1)
    bodies = [
        Body.of_shape("driven", ball, 1.0, actuated="all"),
        Body.of_shape("post", ball, 1.0, base="fixed"),
        Body.of_shape("puck", ball, 1.0, base="planar"),
    ]
    system = System(bodies)
    assert [system.n_a, system.n_u] == [6, 3]


WRONG = {
    "no solid": (
        (Ellipsoid((1, 2, 3)), 1.0),
        "it.shape: must be a Sphere, Box",
    ),
    "no mass": ((Sphere(1), 0.0), "it.mass: must be greater than 0"),
    "not finite": ((Sphere(1), np.nan), "it.mass: must be a finite number"),
    "too heavy": ((Sphere(1), 1e300), "it.mass: must be at most 1e+15 kg"),
    "too large": ((Sphere(1e200), 1.0), "it.shape: must be at most 1e+15 m"),
    "too hard to turn": ((Sphere(1e9), 1.0), "it.inertia: must be at most 1e+15 kg m^2"),
}


@cases("given, says", WRONG)
def test_other_solids_are_refused(given, says):
    with refusal(ModelError, says):
        Body.of_shape("it", *given)


@pytest.mark.parametrize("text", [BALL, f"\n  {BALL}", f"<?xml version='1.0'?>\n{BALL}"])
def test_a_urdf_may_be_given_as_text(text):
    assert System([Body("it", text, "floating")]).masses.tolist() == [0.0, 0.3]


def test_a_mistake_in_a_text_is_said_of_the_text():
    with pytest.raises(ModelError, match=r"^<robot>: line 1: is not well-formed XML"):
        System([Body("it", "<robot")])
    text = BALL.replace("0.05", "-0.05")
    with pytest.raises(ModelError, match=r"^<robot>: link\[ball\]\.collision\[0\]\.sphere\.radius"):
        System([Body("it", text, "floating")])


def test_a_kind_of_box_is_a_box():
    class Crate(Box):
        """A box of a user's own."""

    size = (0.1, 0.2, 0.3)
    crate, box = (System([Body.of_shape("it", kind(size=size), 1.0)]) for kind in (Crate, Box))
    assert crate.M_u(crate.q_start).tobytes() == box.M_u(box.q_start).tobytes()
    assert crate.texts == box.texts
    assert Crate(size=size).words() == Box(size=size).words()
