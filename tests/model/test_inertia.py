"""Inertias of bodies: which no rigid body can have, alone or welded to others."""

from contextlib import nullcontext

import pytest

from quasistatic_ref import ModelError
from tests.files.urdf.urdf_texts import inertial, joint, link, loaded_urdf, robot


@pytest.mark.parametrize("moments", [(0.0, 0.0, 0.0), (1e-3, 1e-3, 0.0), (0.0, 0.0, 1e-3)])
def test_the_remedy_for_a_rod_a_point_mass_or_a_puck_is_an_inertia(moments):
    text = robot(link("a", inertial=inertial("1", moments)))
    with pytest.raises(ModelError, match=r"r write m r\^2/2 about the axis of a rod or disk"):
        loaded_urdf(text, base="floating")


def refused(impossible):
    """An error about the inertia of link a; nothing, if it is possible."""
    says = r"link\[a\].inertial.inertia: is impossible"
    return pytest.raises(ModelError, match=says) if impossible else nullcontext()


def point_mass(centre):
    return inertial("1", ("0",) * 3, f'<origin xyz="{centre}"/>')


def three_points(second):
    """Point masses at 0 and at (2, 0, 0), and a second one in a frame at (1, 1, 0)."""
    return robot(
        link("a", inertial=point_mass("0 0 0")),
        link("b", inertial=point_mass(second)),
        link("c", inertial=point_mass("0 0 0")),
        joint("v", "a", "b", "fixed", more='<origin xyz="1 1 0"/>'),
        joint("w", "a", "c", "fixed", more='<origin xyz="2 0 0"/>'),
    )


def test_point_masses_are_a_body_unless_they_are_in_a_line():
    # I = sum of m (d'd - d d') about the common centre: in a line, none about that line.
    loaded_urdf(three_points("0 0 0"), base="floating")
    with pytest.raises(ModelError, match=r"link\[a\].inertial.inertia: must be positive definite"):
        loaded_urdf(three_points("0 -1 0"), base="floating")


@pytest.mark.parametrize(
    ("moments", "impossible"),
    [
        (("0.012", "0.034", "0.047"), False),  # a unit of the last digit
        (("0.012", "0.034", "0.048"), True),
        (("1.2e-5", "3.49e-4", "3.62e-4"), False),
        (("1.20e-5", "3.490e-4", "3.62e-4"), True),  # of the finest of them
        (("1", "1", "3"), True),
    ],
)
def test_rounding_of_the_last_printed_digit_makes_no_moments_impossible(moments, impossible):
    text = robot(link("a", inertial=inertial("1", moments)))
    with refused(impossible):
        loaded_urdf(text, base="floating")


@pytest.mark.parametrize("moment", ["1e-9999999999999999999", "0e9999999999999999999", "0.0e-400"])
def test_a_moment_of_any_exponent_is_read(moment):
    """It is 0, as of no body; of an actuated link it is only noted."""
    text = robot(link("a", inertial=inertial("1", (moment, "1", "1"))))
    with pytest.raises(ModelError, match=r"inertia: must be positive definite .*got \[0.0, 1.0"):
        loaded_urdf(text, base="floating")
    assert "must be positive definite" in loaded_urdf(text).notes[0]
    exact = robot(link("a", inertial=inertial("1", ("1e-0000000000000000001", "1", "1"))))
    loaded_urdf(exact, base="floating")


@pytest.mark.parametrize(("excess", "impossible"), [(0.01, False), (0.03, True)])
def test_a_welded_link_makes_up_for_an_inertia_as_far_as_parallel_axes_go(excess, impossible):
    # Two links of 1 kg, 0.2 m apart along z: about their common centre each adds 1 kg (0.1 m)^2 to
    # the moments about x and y. So each link's moment about z may exceed the sum of its others by
    # up to 2 (0.1^2) kg m^2 = 0.02 kg m^2.
    moments = ("0.1", "0.1", str(0.2 + excess))
    two = robot(
        link("a", inertial=inertial("1", moments)),
        link("b", inertial=inertial("1", moments)),
        joint("weld", "a", "b", "fixed", more='<origin xyz="0 0 0.2"/>'),
    )
    with refused(impossible):
        assert len(loaded_urdf(two, base="floating").notes) == 2
