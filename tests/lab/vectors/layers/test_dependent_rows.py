"""Layer `derivative` where rows depend on each other: kinks that no single coordinate shows.

A ball of radius 1/4 and 1/2 kg is held between fixed balls of radius 1/2 at x = -3/4 and 3/4, h is
1/8 s. Moved by y = eps the normals are (+-3/4, eps) / (3/4) and both gaps are eps^2 / (3/2). Both
rows together say dy >= -eps / 2. A force c eps across moves it by h^2 c eps / m = c eps / 32 if
nothing holds it; the ball that bears a push p adds p (4/3) eps to that force. Hence, by eps > 0,

    q+_y = eps (1 + max(c / 32 + |p| / 24, -1/2)).
"""

from dataclasses import replace

import numpy as np
import pytest
from flint import fmpq, fmpz_mat

from quasistatic_ref.lab.vectors.exact.precision import vector
from quasistatic_ref.lab.vectors.layers import layer
from quasistatic_ref.lab.vectors.tables import FLOOR
from quasistatic_ref.lab.vectors.unrounded.dependent import dependence_breaks
from quasistatic_ref.lab.vectors.unrounded.derivatives import PROVED, derivatives
from quasistatic_ref.lab.vectors.unrounded.differences import base, quotient
from quasistatic_ref.lab.vectors.unrounded.moved_inputs import (
    with_force,
    with_held_wrenches,
    with_q,
)
from quasistatic_ref.lab.vectors.unrounded.reasons import BEND
from tests.lab.vectors.layers import kinks
from tests.lab.vectors.layers.kinks import squeezed_ball

Y = 1
"""Of delta_q of the ball."""
SQUARE = {"kind": "box", "size": [0.25, 0.25, 0.125]}
CONES = ("frictionless", "pyramid", "product", "facets-6")


def quotient_along(one, way, force):
    """The quotient of q+ as q moves along one vector and the force along another."""

    def inputs(by):
        case = with_q(way, one.at.case, by)
        return with_force(force, case, by)

    return quotient(one, inputs)


def way(j, size=1):
    return fmpq(size) * np.eye(6, dtype=int)[j]


def step_of(case):
    return base(with_held_wrenches(case))


@pytest.mark.parametrize("push", [1, 0])
def test_between_two_balls_the_slope_is_no_sum_of_two_slopes(push):
    one = step_of(squeezed_ball(float(push)))
    still = way(Y, 0)
    for c in (-32, 32, 0):
        found = quotient_along(one, way(Y), way(Y, c))
        held = 1 + max(fmpq(c, 32) + fmpq(push, 24), fmpq(-1, 2))
        assert abs(found.column[Y] - held) < BEND
        assert found.bend < BEND
        alone = [quotient_along(one, way(Y), still), quotient_along(one, still, way(Y, c))]
        assert all(each.bend < BEND for each in alone)
        total = sum(each.column[Y] for each in alone)
        assert abs(total - (1 + fmpq(c, 32) + fmpq(push, 24))) < BEND
        assert (abs(total - held) > fmpq(1, 4)) == (c == -32)


@pytest.mark.parametrize("push", [1.0, 0.0])
def test_a_squeezed_ball_has_no_derivative_and_both_contacts_are_named(push):
    case = squeezed_ball(push)
    output = layer("derivative").expected(case).output
    named = [(reason["kind"], reason["pair"]) for reason in output["reasons"]]
    assert output["differentiable"] is False
    assert named == [("multipliers", "below"), ("multipliers", "above")]
    assert layer("derivative").own(case) == {"differentiable": False}


def box(cone, push=0.5):
    """A box on the floor, on its four corners, of 8 N with what presses it."""
    table = kinks.free_body(SQUARE, [0.0, 0.0, 0.0625], cone=cone)
    return kinks.with_force_on_body(kinks.onto(table, "floor", FLOOR, k=4), [push, 0.25, -4.0])


def sliding_ball(cone):
    """The same pushed with 6 N, two more than friction holds."""
    return box(cone, 6.0)


def ball_between_walls(cone):
    """A ball between two walls."""
    table = kinks.free_body({"kind": "sphere", "radius": 0.25}, [0.0] * 3, cone=cone)
    for name, side in (("left", 1.0), ("right", -1.0)):
        wall = {"kind": "halfspace", "normal": [side, 0.0, 0.0], "offset": -0.25}
        table = kinks.onto(table, name, wall, rows=4)
    return kinks.with_force_on_body(table, [1.0, 0.5, 0.0])


def stuck_ball(cone):
    """A ball between two balls on which it cannot slide, however it is pushed."""
    return squeezed_ball(1.0, cone=cone)


SMOOTH = [(scene, cone) for scene in (box, sliding_ball, ball_between_walls) for cone in CONES]
SMOOTH += [(stuck_ball, cone) for cone in CONES[1:]]


@pytest.mark.parametrize(("scene", "cone"), SMOOTH)
def test_rows_that_go_on_to_depend_on_each_other_leave_the_derivative(scene, cone):
    one = step_of(scene(cone))
    found = one.step.optimum.minimiser
    tight = sorted([*found.working, *found.spanned, *found.unspanned])
    own = one.step.form.rows(tight)
    assert len(own) > fmpz_mat(own).rank()
    found = derivatives(one)
    assert found.reasons == []
    # Along q and, for each coordinate, a force many times what takes the motion back.
    for c in (-64, 64):
        ways = vector(range(1, 7)) / 8
        forces = c * vector(range(3, -3, -1))
        whole = quotient_along(one, ways, forces)
        total = ways @ np.array(found.columns["q"]) + forces @ np.array(found.columns["tau"])
        size = max(map(abs, total))
        assert whole.bend < BEND
        assert max(abs(whole.column - total)) < PROVED * size


def test_a_contact_that_is_replaced_is_compared_with_nothing():
    one = step_of(squeezed_ball(1.0))
    found = quotient_along(one, way(Y), way(Y, 0))
    assert dependence_breaks(one, [found])
    sides = [(step, [_another(contact) for contact in others]) for step, others in found.sides]
    assert not dependence_breaks(one, [replace(found, sides=tuple(sides))])


def _another(contact):
    return replace(contact, near=replace(contact.near, index=contact.near.index + 1))
