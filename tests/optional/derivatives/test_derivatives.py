"""Derivatives of the reference vectors, on both sides and along directions, and what is refused.

The vectors' derivatives, and kinks, are those of differences of steps without rounding.
"""

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    ContactError,
    ContactPair,
    Extension,
    HalfSpace,
    InputError,
    Simulator,
    Sphere,
    System,
    derivatives,
)
from quasistatic_ref.lab.vectors.check.case import case_verdict
from quasistatic_ref.lab.vectors.check.loosened import loosened
from quasistatic_ref.lab.vectors.layers import layer
from quasistatic_ref.lab.vectors.own.step import posed_case
from quasistatic_ref.optional.derivatives.column import SHARES
from quasistatic_ref.optional.derivatives.nearby import PLACE
from tests.cases import first, parts
from tests.closeness import assert_same, assert_within
from tests.contact.still import placed_shape
from tests.files.urdf.urdf_texts import collision, joint, link, robot
from tests.lab.vectors.committed_cases import cases, expected_of
from tests.optional.derivatives.free_bodies import (
    FLOOR,
    NONE,
    G,
    H,
    falling_ball,
    free,
    slope,
    vector_scene,
)
from tests.tolerances import DIFFERENCE_OF_STEPS

DIGITS = 5
PARTS = 40
IS_KINK = "/kink/"
HARDEST = "derivative/random/96"
"""Its derivatives by q are the least well known, and small; README's line takes it, too."""

X, _, Z = np.eye(6)[:3]


@pytest.mark.parametrize("part", parts(24))
def test_every_kink_of_the_vectors_is_seen(part):
    kinks = [case for case in cases("derivative") if IS_KINK in case.id]
    assert len(kinks) == 57
    for case in kinks[part::24]:
        try:
            posed = posed_case(case.input)
            found = derivatives(posed.simulator, posed.q, posed.q_bar_a, posed.force, by="q")
        except ContactError:  # the normal is one of several
            continue
        assert not found.differentiable, case.id
        assert all(reason.sentence for reason in found.reasons)


@pytest.mark.parametrize("part", parts(PARTS))
def test_vectors_have_their_derivatives_by_every_parameter_and_no_invented_kink(part):
    smooth = [case for case in cases("derivative") if IS_KINK not in case.id]
    assert len(smooth) == 280
    hardest = [case for case in smooth if case.id == HARDEST and not part]
    for case in [*smooth[part::PARTS], *hardest]:
        record = loosened(expected_of("derivative")[case.id], DIGITS)
        answer = layer("derivative").own(case.input)
        verdict = case_verdict("derivative", case.input, record, answer)
        assert (verdict.verdict, verdict.without) == ("passed", ()), (case.id, verdict)


def test_all_paths_have_the_same_derivatives():
    plain, q, q_bar_a = vector_scene("floating/push")
    rough, _, _ = vector_scene("floating/push", certify="residual", backend="daqp")
    found = derivatives(plain, q, q_bar_a)
    proved, _, _ = vector_scene("floating/push", backend="daqp")
    for other in (rough, proved):
        again = derivatives(other, q, q_bar_a)
        assert_same(again.result.q, found.result.q)
        for name, sides in found.by.items():
            assert_same(again.by[name].rate, sides.rate)


def test_a_ball_that_just_reaches_the_floor_falls_above_it_and_rests_below():
    simulator, q = falling_ball()
    found = derivatives(simulator, q, NONE, by=("q", "h", "mu_v"))
    assert not found.differentiable
    assert np.isnan(found.dq_dq[:, 2]).all()
    assert np.isfinite(found.dq_dq[:, :2]).all()
    (reason,) = (why for why in found.reasons if "dq_dh" in why.fields)
    rows = tuple(f"{row} of c0/0" for row in ("+d1", "+d2", "+spin", "-d1", "-d2", "-spin"))
    assert (reason.rows, reason.points) == (rows, ())
    assert reason.fields == ("dq_dq", "dq_dh")
    sides = found.by["q"]
    assert_within(sides.above[2, 2], 1.0, DIFFERENCE_OF_STEPS)
    assert_within(sides.below[2, 2], 0.0, DIFFERENCE_OF_STEPS)
    # It falls by h^2 g; a longer step ends on the floor.
    assert_within(found.by["h"].below[2, 0], -2 * H * G, DIFFERENCE_OF_STEPS)
    assert_within(found.by["h"].above[2, 0], 0.0, DIFFERENCE_OF_STEPS)


@pytest.mark.parametrize("gap", [3e-14, -3e-14])
def test_a_kink_that_is_nearer_than_any_difference_is_one(gap):
    simulator, q = falling_ball(gap)
    found = derivatives(simulator, q, NONE)
    assert_within(found.along(q=Z)[2], 1.0, DIFFERENCE_OF_STEPS)
    assert_within(found.along(q=-Z)[2], 0.0, DIFFERENCE_OF_STEPS)


@pytest.mark.parametrize("gap", [1e-6, 1e-4])
def test_a_derivative_holds_as_far_as_steps_say(gap):
    simulator, q = falling_ball(gap)
    sides = derivatives(simulator, q, NONE, by="q").by["q"]
    assert_within(sides.rate[2, 2], 1.0, DIFFERENCE_OF_STEPS)
    assert sides.holds[2] <= 1.01 * gap


@pytest.mark.parametrize("way", [Z, -Z, np.array([1.0, 2, -3, 4, 5, 6])])
def test_along_a_direction_several_parameters_change_at_once(way):
    simulator, q = falling_ball()
    found = derivatives(simulator, q, NONE, by=())
    assert found.differentiable
    there = slope(simulator, found.result.q, q, way, change=X)
    assert_within(found.along(q=way, tau=X), there, DIFFERENCE_OF_STEPS * np.abs(way).max())
    assert_same(found.along(q=0 * way), np.zeros(6))


def test_friction_of_zero_has_a_derivative_from_above_alone():
    simulator, q = free(Sphere(0.05), (0, 0, 0.05), FLOOR, mu=(0.0, 0.01))
    found = derivatives(simulator, q, NONE, 0.1 * X, by=("mu_v", "mu_omega"))
    assert found.differentiable
    assert np.isnan(found.by["mu_v"].below).all()
    assert_same(found.dq_dmu_v, found.by["mu_v"].above)
    assert_same(found.along(mu_v=[0.1]), 0.1 * found.dq_dmu_v[:, 0])
    assert np.isfinite(found.dq_dmu_omega).all()
    with pytest.raises(InputError, match=r"along: .* a parameter of zero cannot fall"):
        found.along(mu_v=[-0.1])


def test_a_step_without_derivatives_is_refused_in_a_sentence():
    simulator, q, q_bar_a = vector_scene("floating/push", cone="ellipsoid")
    with pytest.raises(InputError, match="polyhedron"):
        derivatives(simulator, q, q_bar_a)
    simulator, q, q_bar_a = vector_scene("floating/push", extension=lambda q: Extension((), 0.0))
    with pytest.raises(InputError, match="any function of q"):
        derivatives(simulator, q, q_bar_a)
    simulator, q = falling_ball(1e-3)
    with pytest.raises(InputError, match=r"by: must be one of q, q_bar_a, .* \(got 'mass'\)"):
        derivatives(simulator, q, NONE, by=("q", "mass"))
    found = derivatives(simulator, q, NONE, by="q")
    with pytest.raises(InputError, match="dq_dtau: was not asked for"):
        _ = found.dq_dtau
    with pytest.raises(InputError, match="along: must be one of q,"):
        found.along(p=np.zeros(6))
    with pytest.raises(InputError, match=r"along\.tau: must have shape \(6,\)"):
        found.along(tau=np.ones((1, 6)))
    with pytest.raises(InputError, match=r"along\.q: must contain finite"):
        found.along(q=np.full(6, np.inf))


RAIL = robot(
    link("rail"),
    link("ball", collision('<sphere radius="0.1"/>')),
    joint("z", "rail", "ball", "prismatic", "0 0 1"),
)
KINKS = {
    "a floor": (FLOOR, 0.1, 0.0, (0.0, 1.0)),
    "a lid": (HalfSpace((0, 0, -1), 0.0), -0.1, 0.0, (1.0, 0.0)),
    "a landing": (FLOOR, 0.1 + H**2 * G, -G, (0.0, 1.0)),
}
"""Half-space, height of a ball at which its step has a kink, gravity, slopes below and above."""
DIFFERENCES = [eps * PLACE for eps in SHARES]
"""Those that are taken of a height [m]."""
RATIOS = {m / n for m in range(1, 7) for n in range(1, 7)}
BESIDE = (0.0, 1e-8, -1e-8)


def wrong_slopes(kink, away):
    """The slopes of a ball on a rail that are none, where a kink is some way below it [m]."""
    wall, height, g, slopes = KINKS[kink]
    system = System([Body("b", RAIL)])
    pair = ContactPair("p", placed_shape(wall), system.shapes[0], 0.5, 0.001)
    simulator = Simulator(system, [pair], h=H, gravity=(0, 0, g), backend="daqp")
    found = derivatives(simulator, [height + away], NONE, by="q").by["q"]
    right = slopes[int(away > 0)]
    # A one-sided slope beyond a kink that is nearer than the differences is that beyond it.
    given = {"rate": (right,), "below": (right, slopes[0]), "above": (right, slopes[1])}
    off = {name: np.abs(getattr(found, name)[0, 0] - many).min() for name, many in given.items()}
    return {(name, away): error for name, error in off.items() if error > DIFFERENCE_OF_STEPS}


@pytest.mark.parametrize("every", first(1, [16, 1]))
@pytest.mark.parametrize("kink", KINKS)
def test_no_slope_is_wrong_at_a_share_of_a_difference_from_a_kink(kink, every):
    """At m/n of each, m and n to 6, and 1e-8 of that beside, on either side."""
    depths = [d * r * (1 + b) for d in DIFFERENCES for r in sorted(RATIOS) for b in BESIDE]
    places = [sign * depth for depth in depths for sign in (-1, 1)]
    wrong = [found for away in places[::every] if (found := wrong_slopes(kink, away))]
    assert wrong == []


@pytest.mark.parametrize("kink", KINKS)
def test_no_slope_is_wrong_at_a_drawn_distance_from_a_kink(kink, rng):
    places = rng.choice([-1, 1], 40) * 10.0 ** rng.uniform(-10, -3, 40)
    assert [found for away in places if (found := wrong_slopes(kink, away))] == []
