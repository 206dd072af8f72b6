"""Steps as functions of JAX: its own check of gradients, kinks, the arguments of a step."""

from importlib import import_module

import numpy as np
import pytest

from quasistatic_ref import (
    HalfSpace,
    InputError,
    NotDifferentiable,
    Sphere,
    derivatives,
    step_jax,
)
from quasistatic_ref.lab.made_steps.nudge import RADIUS, body_at_rest, points
from quasistatic_ref.optional.derivatives.nearby import Nearby
from tests.closeness import assert_same, assert_within
from tests.extras import reason as needs
from tests.optional.derivatives.free_bodies import (
    BOX,
    FLOOR,
    NONE,
    falling_ball,
    free,
    vector_scene,
)
from tests.optional.pushed_block import FACE, TIP_RADIUS, pushed_block
from tests.tolerances import JAX_GRADIENT, JAX_STEP

jax = pytest.importorskip("jax", reason=needs("jax"))
pytestmark = pytest.mark.extra("jax")
check_grads = import_module("jax.test_util").check_grads


@pytest.fixture(autouse=True)
def in_float64():
    with jax.enable_x64(True):
        yield


def check_against_differences(function, *given):
    """JAX's comparison with differences, forwards and backwards, along random directions."""
    check_grads(
        function, given, 1, ("fwd", "rev"), atol=JAX_GRADIENT, rtol=JAX_GRADIENT, eps=JAX_STEP
    )


def floating_hand_and_body():
    """A hand and a body, both floating: quaternions in q and in q_bar_a."""
    return vector_scene("floating/push")


def turning_block():
    """A block that turns by (cos, sin), and a finger that pushes it along two rails."""
    behind = FACE + TIP_RADIUS + 1e-4
    x, y = -behind * np.cos(0.3), -behind * np.sin(0.3)
    scenario = pushed_block(x, y, turn=0.3, fast=True)
    return scenario.simulator(), scenario.system.q_start, np.array([4e-3, 1e-3])


def planar_box():
    """A box in the plane, one corner of which is pushed into a wall."""
    wall = HalfSpace((0, 0, 1), -1.0)
    simulator, q = free(BOX, (0, 0.02, 0), wall, base="planar", rpy=(0, 0, 0.3))
    return simulator, q, NONE


def ball():
    """A box on a ball joint, one corner of which is pushed into the floor."""
    at = (0, 0, 0.129)
    simulator, q = free(BOX, at, FLOOR, base="ball", rpy=(0.4, 0.5, 0.3))
    return simulator, q, NONE


SCENES = {
    "floating": floating_hand_and_body,
    "turning": turning_block,
    "planar": planar_box,
    "ball": ball,
}


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_gradients_of_a_step_pass_the_check_of_jax(scene):
    simulator, q, goal = scene()
    step = step_jax(simulator)
    force = np.linspace(0.1, 0.2, simulator.system.n_v)
    assert_same(step(q, goal, force), simulator.step(q, goal, force).q)
    check_against_differences(step, q, goal, force)
    check_against_differences(jax.jit(step), q, goal, force)


def test_gradients_of_steps_in_sequence_pass_the_check_of_jax():
    simulator, q, goal = turning_block()
    step = step_jax(simulator)

    def run(goals):
        return jax.lax.scan(lambda q, goal: (step(q, goal), 0.0), jax.numpy.asarray(q), goals)[0]

    check_against_differences(run, goal + np.linspace(0, 4e-3, 3)[:, None])


def test_entries_of_any_length_stand_for_unit_ones():
    simulator, q, goal = floating_hand_and_body()
    step = step_jax(simulator)
    long = q.copy()
    long[3:7] *= 1.5
    assert_within(step(long, goal), step(q, goal))
    by_q = jax.jacrev(step)(q, goal)
    by_long = jax.jacrev(step)(long, goal)
    assert_within(1.5 * by_long[:, 3:7], by_q[:, 3:7], JAX_GRADIENT)


def test_at_a_kink_the_step_is_there_and_its_gradient_is_an_error():
    simulator, q = falling_ball()
    step = step_jax(simulator)
    assert_same(step(q, NONE), simulator.step(q, NONE).q)
    with pytest.raises(
        NotDifferentiable, match=r"no derivative here: rows .* \+d1 of c0/0"
    ) as error:
        jax.grad(lambda q: step(q, NONE)[2])(q)
    assert error.value.reasons == derivatives(simulator, q, NONE, by="q").reasons
    with pytest.raises(NotDifferentiable, match=r"\+d1 of c0/0"):
        jax.jvp(lambda q: step(q, NONE), (q,), (np.eye(7)[2],))
    with pytest.raises(jax.errors.JaxRuntimeError, match="no derivative here: rows"):
        jax.block_until_ready(jax.jit(jax.grad(lambda q: step(q, NONE)[2]))(q))


def test_a_kink_that_does_not_concern_what_is_asked_for_is_no_error():
    simulator, q = body_at_rest(points((-0.05, 0.0, 0.0), (0.05, 0.0, 0.0)), 0.0)
    step = step_jax(simulator)
    assert np.isfinite(jax.jacrev(lambda force: step(q, NONE, force))(np.zeros(6))).all()
    _, aside = jax.jvp(lambda q: step(q, NONE), (q,), (np.eye(7)[0],))
    assert np.isfinite(aside).all()
    with pytest.raises(NotDifferentiable, match="closest points on one side only: floor/0"):
        jax.jacfwd(lambda q: step(q, NONE))(q)


@pytest.mark.parametrize("twice", [jax.hessian, lambda f: jax.jit(jax.jacrev(jax.grad(f)))])
def test_second_derivatives_are_refused_in_a_sentence(twice):
    simulator, q = body_at_rest(Sphere(RADIUS), RADIUS)
    step = step_jax(simulator)
    with pytest.raises(InputError, match="step in JAX: has no second derivative"):
        twice(lambda force: step(q, NONE, force)[2])(np.zeros(6))


def test_forwards_a_gradient_is_one_column(monkeypatch):
    """Its steps: q+, the same under the column, and the four of that."""
    simulator, q, goal = floating_hand_and_body()
    step = step_jax(simulator)
    solved = []
    proved = Nearby.end
    monkeypatch.setattr(Nearby, "end", lambda *args: solved.append(1) or proved(*args))

    def along(q, t):
        return jax.jvp(lambda q: step(q, goal), (q,), (t,))[1]

    tangent = np.linspace(-1, 1, len(q))
    one = along(q, tangent)
    assert len(solved) == 4
    assert_within(jax.jit(along)(q, tangent), one)
    assert len(solved) == 8
    assert_within(jax.jacrev(lambda q: step(q, goal))(q) @ tangent, one, JAX_GRADIENT)


def test_of_several_steps_each_has_its_own_gradient():
    simulator, q, goal = floating_hand_and_body()
    step = step_jax(simulator)
    both = np.stack([q, simulator.step(q, goal).q])
    each = np.stack([jax.jacrev(step)(one, goal) for one in both])
    for mode in (jax.jacfwd, jax.jacrev):
        by_q = jax.jit(jax.vmap(mode(step), (0, None)))(both, goal)
        assert_within(by_q, each, JAX_GRADIENT)
    by_sum = jax.grad(lambda every: jax.vmap(step, (0, None))(every, goal).sum())(both)
    assert_within(by_sum, each.sum(axis=1), JAX_GRADIENT)


WRONG = {
    "a number": lambda q, target: (q, target, 0.5),
    "a batch": lambda q, target: (np.stack([q, q]), np.stack([target, target])),
    "a short target": lambda q, target: (q, target[:6]),
}


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("how", [lambda step: step, jax.jit], ids=["alone", "jit"])
def test_arguments_have_the_shapes_of_simulator_step(wrong, how):
    simulator, q, target = floating_hand_and_body()
    arguments = WRONG[wrong](q, target)
    with pytest.raises(InputError):
        simulator.step(*arguments)
    with pytest.raises(InputError, match=r"must have shape .*jax\.vmap"):
        how(step_jax(simulator))(*arguments)


def test_whole_numbers_are_numbers_and_float32_is_named():
    simulator, q, target = floating_hand_and_body()
    step = step_jax(simulator)
    force = 3 * np.arange(12)
    assert_same(step(q, target, force), simulator.step(q, target, force).q)
    assert_same(step(q, target, 0), simulator.step(q, target).q)
    with pytest.raises(InputError, match=r"q: must be float64; make it so .*float32"):
        step(q.astype(np.float32), target)
    with jax.enable_x64(False), pytest.raises(InputError, match="jax_enable_x64"):
        step(q, target)


def test_under_jit_an_error_about_values_is_jax_s():
    simulator, q, target = floating_hand_and_body()
    step = jax.jit(step_jax(simulator))
    with pytest.raises(jax.errors.JaxRuntimeError, match="finite"):
        jax.block_until_ready(step(np.full_like(q, np.nan), target))
