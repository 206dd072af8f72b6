"""Steps in the ellipsoid: enclosed in balls, exact at apexes, verified, refused where they lie."""

from dataclasses import replace

import numpy as np
import pytest
from flint import arb

from quasistatic_ref import (
    Extra,
    InputError,
    StepNotSolved,
    contact_forces,
    save_step,
    solve_step,
    verify,
    verify_answer,
)
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.optimum import step_optimum
from quasistatic_ref.optional.ellipsoid import enclosure as of_enclosure
from quasistatic_ref.optional.ellipsoid import forces as of_forces
from quasistatic_ref.optional.ellipsoid.interior import interior_point
from quasistatic_ref.optional.friction import cone_matrix
from tests.closeness import assert_relative, assert_same, assert_within
from tests.helpers import (
    EAST,
    WEST,
    pinch,
    point_between_walls,
    point_on_floor,
)
from tests.made import Y, frames_about, rigid_step
from tests.oracles.random_steps import drawn
from tests.tolerances import ROUNDING

CONED = ("clarabel", "scs")


def round_step(step):
    return step.replace(cone="ellipsoid")


@pytest.mark.parametrize("angle", [0.0, 2.0])
def test_a_sliding_point_has_the_closed_form_of_a_circular_cone(angle):
    # A mass m, pushed by F along the floor and by W = m g down, slides if F > mu W. KKT with lam_n:
    # m/h v = h F - mu lam_n along the push, m/h w = lam_n - h W upwards, w = mu v (lift-off):
    # m/h mu v = lam_n - h W  and  m/h v = h F - mu lam_n  give  v (1 + mu^2) = h^2 (F - mu W) / m.
    m = 0.3
    mu = 0.5
    F = 4.0
    W = 0.3 * 9.81
    h = 0.01
    push = F * np.array([np.cos(angle), np.sin(angle)])
    load = np.array([*push, -W])
    step = round_step(point_on_floor(m, mu, force=load, h=h))
    v = h**2 * (F - mu * W) / m / (1 + mu**2)
    expected = np.array([*(v * push / F), mu * v])
    for backend in CONED:
        answer = solve_step(step, backend)
        assert answer.certificate.kind == "enclosure"
        np.testing.assert_allclose(answer.delta_q, expected, rtol=ROUNDING, atol=ROUNDING * v)
        assert_relative(answer.net_impulse, m / h * expected - h * load)
        f_1, f_2, f_n, _ = answer.wrench[0]
        assert_relative(np.hypot(f_1, f_2), mu * f_n)
        assert verify(answer)


def test_a_grasp_is_enclosed_and_every_backend_gives_the_same_bits(rng):
    step = round_step(drawn(rng, "grasp"))
    answers = [solve_step(step, backend) for backend in (*CONED, "none")]
    for answer in answers:
        assert answer.certificate.kind == "enclosure"
        assert answer.certificate.error_bound < ROUNDING / 10
        assert max(answer.certificate.residuals.values()) < ROUNDING
        assert_same(answer.delta_q, answers[0].delta_q)
    assert verify(answers[0])


def test_without_multipliers_nothing_is_proved():
    step = round_step(pinch(grip=5.0, offset=0.2))
    answer = solve_step(step)
    without = verify_answer(step, answer.delta_q, (), None, answer.certificate)
    assert "nothing is proved without lam" in without.reason


def test_a_set_without_interior_is_reported_as_uncertified(tmp_path, cli):
    # Two walls without friction, opposite, both touching: only the plane between them is left.
    step = round_step(point_between_walls([EAST, WEST], 0.0, force=(1.0, 2.0, 3.0)))
    answer = solve_step(step)
    assert answer.certificate.kind == "residual"
    assert answer.certificate.error_bound is None
    path = save_step(tmp_path / "step.json", step)
    assert "not proved: worst residual" in cli("solve", path).err
    assert_within(answer.delta_q[0], 0.0, 1e-12)
    # Compliance c gives it an interior; the wall that is pressed bears 1 N / (1 + m c / h^2).
    assert sorted(answer.forces[:, 2]) == pytest.approx([0.0, 1.0], rel=1e-3, abs=0.0)


def test_an_infeasible_step_is_not_solved():
    with pytest.raises(StepNotSolved):
        solve_step(round_step(point_between_walls([EAST, WEST], -1e-3)))


def test_rows_of_the_user_s_own_stand_beside_the_ellipsoid():
    extra = Extra(("stop",), [[0.0] * 4 + [1.0] + [0.0] * 3], [-1e-4])
    step = round_step(pinch(grip=5.0, offset=0.2)).replace(extra=extra)
    answer = solve_step(step)
    assert answer.certificate.kind == "enclosure"
    assert_relative(answer.delta_q[4], -1e-4)
    assert answer.lam_extra[0] > 0
    assert verify(answer)


def test_the_methods_of_polyhedra_refuse_the_ellipsoid():
    step = round_step(pinch())
    with pytest.raises(InputError, match="has no rows"):
        cone_matrix(step.cone)
    with pytest.raises(InputError, match="has no rational optimum"):
        step_optimum(step)
    assert "proves nothing of a cone" in str(farkas_refutation(step, ["1"] * 8))


def test_a_contact_without_load_is_inside_of_its_cone():
    """Where no gap is claimed, what sticks out is compared with the largest impulse, here 0."""
    step = round_step(point_on_floor(phi=1.0, force=(1.0, 0.0, -1.0)))
    answer = solve_step(step)
    assert (answer.certificate.kind, answer.certificate.active) == ("exact", ())
    assert_relative(answer.delta_q, 1e-4 * np.array([1.0, 0.0, -1.0]) / 0.3)
    assert not answer.lam.any()
    assert verify(replace(answer, certificate=replace(answer.certificate, gap=None)))


def test_an_enclosure_holds_the_answer_however_wide_it_is(monkeypatch):
    """Forces by compliance from a pair that is far off, which is accepted on request alone."""
    step = round_step(pinch())
    sharp = solve_step(step)
    answer = np.concatenate([sharp.forces[:, [2, 0, 1, 3]], sharp.compliant.delta_q], axis=None)
    balls = []
    for module in (of_forces, of_enclosure):
        monkeypatch.setattr(module, "rounded", lambda ball: balls.append(ball) or float(ball))
    far = arb(2) ** -30
    monkeypatch.setattr(
        of_forces, "guesses", lambda frame, _: [(interior_point(frame.problem, far), [])]
    )
    with pytest.raises(StepNotSolved, match="no enclosure"):
        contact_forces(step)
    monkeypatch.setattr(of_forces, "WIDE", 2 * far)
    contact_forces(step)
    middles, radii = np.array([[float(ball.mid()), float(ball.rad())] for ball in balls]).T
    off = np.abs(middles - answer)
    assert (off <= radii).all()
    assert (off > ROUNDING * np.abs(answer)).any()  # by more than rounding


@pytest.mark.parametrize("share", [1.0, 1e-9, 0.0])
def test_a_bound_does_not_vanish_as_gravity_fades(share):
    """Two tilted planes push a ball out while it slides: x* is the length, whatever the load.

    What is left is the rounding of delta_q to float64, at most 2^-53 of each entry.
    """
    n = np.array([[np.sin(a), 0.0, np.cos(a)] for a in (0.5, -0.9)])
    weight = [0.0, 0.0, share * -9.81 * 0.3, 0.0, 0.0, 0.0]
    step = rigid_step(
        0.3, 3e-4, weight, -0.05 * n, frames_about(n, Y),
        mu_v=[0.2, 0.3], mu_omega=0.01, phi=[-1e-4, -3e-5], rows=6,
    )  # fmt: skip
    answer = solve_step(round_step(step))
    assert answer.certificate.kind == "enclosure"
    assert answer.certificate.error_bound < 2.0**-53 * np.sqrt(6)
    assert verify(answer)
