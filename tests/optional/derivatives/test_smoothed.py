"""The smoothed step: differences, a closed form at every size, and what is refused."""

import numpy as np
import pytest

from quasistatic_ref import InputError, Sphere, StepNotSolved, smoothed
from quasistatic_ref.lab.scenes.nudge import RADIUS, body_at_rest
from quasistatic_ref.optional.derivatives.step import barrier as newton
from quasistatic_ref.optional.derivatives.step.barrier import barrier_step
from tests.certify.test_farkas import EAST, WEST, point_between_walls
from tests.closeness import assert_relative, assert_within
from tests.helpers import point_on_floor
from tests.optional.derivatives.free_bodies import NONE, vector_scene
from tests.oracles.differences import rate, unit
from tests.tolerances import ACTIVE_SET, CLOSED_FORM, DIFFERENCE_OF_STEPS


@pytest.mark.parametrize("name", ["ellipsoid_capsule_0", "box_cloud_1", "cone_convex_0"])
@pytest.mark.parametrize("kappa", [1e-4, 1e-8])
def test_r36_derivatives_of_a_smoothed_push_agree_with_differences(name, kappa, rng):
    simulator, q, q_bar_a = vector_scene(f"pair/{name}")
    found = smoothed(simulator, q, q_bar_a, kappa)
    assert found.differentiable
    system = simulator.system
    e = unit(rng, system.n_v)

    def end(q, force=0.0):
        return system.difference(
            found.result.q, smoothed(simulator, q, q_bar_a, kappa, force).result.q
        )

    moved = rate(lambda t: end(system.integrate(q, t * e)), 1e-6)
    size = np.abs(found.dq_dq).max()
    assert_within(found.dq_dq @ e, moved, 10 * DIFFERENCE_OF_STEPS * size)
    assert_within(found.along(q=e), found.dq_dq @ e, 1e-9 * size)
    pressed = rate(lambda t: end(q, t * e), 1e-4)
    size = np.abs(found.dq_dtau).max()
    assert_within(found.dq_dtau @ e, pressed, 10 * DIFFERENCE_OF_STEPS * size)


def pressed_point(scale):
    """A point that is pressed onto a floor without friction, kappa, and how high it hovers.

    Of its four equal rows each pushes with kappa / z: m z / h + h force = 4 kappa / z.
    """
    kappa = 1e-4 * scale
    step = point_on_floor(0.3 * scale, 0.0, force=(0.0, 0.0, -2.0 * scale), h=0.01)
    z = max(np.roots([0.3 * scale / 0.01, 0.01 * 2.0 * scale, -4 * kappa]))
    return step, kappa, z


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e-12, 1e12])
def test_a_pressed_point_hovers_at_the_root_of_its_balance_at_any_size(scale):
    step, kappa, z = pressed_point(scale)
    barrier = barrier_step(step, kappa)
    assert_relative(barrier.x, [0.0, 0.0, z], CLOSED_FORM)
    assert_relative(barrier.lam, kappa / barrier.slack, CLOSED_FORM)


def test_newton_s_method_cut_short_gives_the_minimiser_or_nothing(monkeypatch):
    step, kappa, z = pressed_point(1e-12)
    answers = 0
    for steps in range(30):
        monkeypatch.setattr(newton, "STEPS", steps)
        try:
            barrier = barrier_step(step, kappa)
        except StepNotSolved:
            assert not answers
            continue
        assert_relative(barrier.x, [0.0, 0.0, z], ACTIVE_SET)
        answers += 1
    assert 0 < answers < 29


def test_what_cannot_be_smoothed_is_refused():
    simulator, q = body_at_rest(Sphere(RADIUS), RADIUS)
    with pytest.raises(InputError, match="greater than 0"):
        smoothed(simulator, q, NONE, 0.0)
    closed = point_between_walls([EAST, WEST], -1e-3)
    with pytest.raises(StepNotSolved, match="strictly inside"):
        barrier_step(closed, 1e-6)
