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
    smoothed,
)
from quasistatic_ref.lab.scenes.nudge import RADIUS, body_at_rest, points
from quasistatic_ref.lab.scenes.pushed_block import pushed_block
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.step_jax import smoothed_jax, step_jax
from tests.closeness import assert_relative, assert_same, assert_within
from tests.extras import reason as needs
from tests.optional.derivatives.free_bodies import (
    BOX,
    FLOOR,
    NONE,
    falling_ball,
    free,
    vector_scene,
)
from tests.tolerances import JAX_GRADIENT, JAX_STEP

jax = pytest.importorskip("jax", reason=needs("jax"))
pytestmark = pytest.mark.extra("jax")
check_grads = import_module("jax.test_util").check_grads

UP = np.eye(6)[2]


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
    scene = pushed_block(cone="pyramid")
    q = scene.q_at(0.01, 0.02, 0.3, 1e-4)
    return scene.simulator, q, q[:2] + np.array([4e-3, 1e-3])


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
    q_next, verdict = step(q, goal, force)
    assert (np.asarray(q_next) == simulator.step(q, goal, force).q).all()
    assert not verdict.any()
    check_against_differences(lambda *given: step(*given)[0], q, goal, force)
    check_against_differences(jax.jit(lambda *given: step(*given)[0]), q, goal, force)


def test_gradients_of_smoothed_steps_in_sequence_pass_the_check_of_jax():
    simulator, q, goal = turning_block()
    step = smoothed_jax(simulator)
    ended = smoothed(simulator, q, goal, 1e-6).result.q
    assert (np.asarray(step(q, goal, 1e-6)[0]) == ended).all()

    def run(goals):
        return jax.lax.scan(lambda q, goal: step(q, goal, 1e-6), jax.numpy.asarray(q), goals)

    goals = goal + np.linspace(0, 4e-3, 5)[:, None]
    assert not run(goals)[1].any()
    check_against_differences(lambda goals: run(goals)[0], goals)


def test_at_a_kink_the_step_is_there_and_its_gradient_is_an_error():
    simulator, q = falling_ball()
    step = step_jax(simulator)
    q_next, verdict = step(q, NONE)
    assert (np.asarray(q_next) == simulator.step(q, NONE).q).all()
    assert [kind for kind, is_so in zip(reason.KINDS, verdict, strict=True) if is_so] == [
        reason.WEAK
    ]
    with pytest.raises(
        NotDifferentiable, match=r"no derivative here: row .* without load"
    ) as error:
        jax.grad(lambda q: step(q, NONE)[0][2])(q)
    assert error.value.reasons == derivatives(simulator, q, NONE).reasons
    with pytest.raises(jax.errors.JaxRuntimeError, match="no derivative here: row"):
        jax.block_until_ready(jax.jit(jax.grad(lambda q: step(q, NONE)[0][2]))(q))


def test_a_kink_that_does_not_concern_what_is_asked_for_is_only_said():
    simulator, q = body_at_rest(points((-0.05, 0.0, 0.0), (0.05, 0.0, 0.0)), 0.0)
    step = step_jax(simulator)
    by_force, verdict = jax.jacrev(lambda force: step(q, NONE, force), has_aux=True)(np.zeros(6))
    assert verdict[reason.KINDS.index(reason.POINTS)]
    assert np.isfinite(by_force).all()
    with pytest.raises(NotDifferentiable, match="as near as each other"):
        jax.jacfwd(lambda q: step(q, NONE)[0])(q)


@pytest.mark.parametrize(("way", "slope"), [(UP, 1.0), (-UP, 0.0)])
def test_one_sided_gradients_are_those_of_the_side_that_is_named(way, slope):
    simulator, q = falling_ball()
    step = step_jax(simulator, "one-sided", towards={"q": way})
    (height, verdict), by_q = jax.value_and_grad(
        lambda q: (step(q, NONE)[0][2], step(q, NONE)[1]), has_aux=True
    )(q)
    assert float(height) == simulator.step(q, NONE).q[2]
    assert verdict.any()
    # Above the kink it falls as a free body does; below it ends on the floor.
    assert_within(by_q[2], slope)


def test_smoothed_gradients_at_kinks_leave_the_step_exact():
    simulator, q = falling_ball()
    step = step_jax(simulator, "smoothed", kappa=1e-9)
    height, by_q = jax.value_and_grad(lambda q: step(q, NONE)[0][2])(q)
    assert float(height) == simulator.step(q, NONE).q[2]
    # At the kink s^2 m / h = 6 kappa, and ds / dphi = s m / h / (2 s m / h): one half.
    assert_relative(by_q[2], 0.5, 1e-9)


def test_a_wrong_question_is_refused_in_a_sentence():
    simulator, q = falling_ball()
    with pytest.raises(InputError, match="kinks: must be one of raise, one-sided, smoothed"):
        step_jax(simulator, "ignore")
    with pytest.raises(InputError, match="kappa: goes with kinks='smoothed'"):
        step_jax(simulator, kappa=1e-6)
    with pytest.raises(InputError, match="towards: goes with kinks='one-sided'"):
        step_jax(simulator, "one-sided")
    with pytest.raises(InputError, match="kappa: has no derivative"):
        jax.grad(lambda kappa: smoothed_jax(simulator)(q, NONE, kappa)[0][2])(1e-6)


@pytest.mark.parametrize("twice", [jax.hessian, lambda f: jax.jit(jax.jacrev(jax.grad(f)))])
def test_second_derivatives_are_refused_in_a_sentence(twice):
    simulator, q = body_at_rest(Sphere(RADIUS), RADIUS)
    step = step_jax(simulator)
    with pytest.raises(InputError, match="step in JAX: has no second derivative"):
        twice(lambda force: step(q, NONE, force)[0][2])(np.zeros(6))


def test_elements_of_a_vmap_are_steps_taken_once(monkeypatch):
    simulator, q = body_at_rest(Sphere(RADIUS), RADIUS)
    end = simulator.step(q, NONE).q
    taken = []
    step_of = type(simulator).step
    monkeypatch.setattr(type(simulator), "step", lambda *args: taken.append(1) or step_of(*args))
    step = step_jax(simulator)
    three = np.tile(q, (3, 1))
    assert_same(jax.vmap(lambda q: step(q, NONE)[0])(three), [end] * 3)
    taken.clear()
    by_q = jax.jit(jax.vmap(jax.jacfwd(lambda q: step(q, NONE)[0])))
    jax.block_until_ready(by_q(three))
    assert len(taken) == 3


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
    assert_same(step(q, target, force)[0], simulator.step(q, target, force).q)
    assert_same(step(q, target, 0)[0], simulator.step(q, target).q)
    smooth = smoothed_jax(simulator)
    assert_same(smooth(q, target, 1)[0], smooth(q, target, 1.0)[0])
    with pytest.raises(InputError, match=r"q: must be float64; make it so .*float32"):
        step(q.astype(np.float32), target)
    with pytest.raises(InputError, match="kappa: must be float64; make it so"):
        smooth(q, target, np.float32(1e-6))
    with jax.enable_x64(False), pytest.raises(InputError, match="jax_enable_x64"):
        step(q, target)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -1.0, True, "1e-9", [1e-9, 1e-9]])
def test_what_is_no_weight_and_no_distance_is_refused(bad):
    simulator, q, target = floating_hand_and_body()
    with pytest.raises(InputError, match="kappa"):
        smoothed(simulator, q, target, bad)
    with pytest.raises(InputError, match="nearly"):
        derivatives(simulator, q, target, nearly=bad)
    with pytest.raises(InputError, match="nearly"):
        step_jax(simulator, nearly=bad)
    with pytest.raises(InputError, match="kappa"):
        step_jax(simulator, "smoothed", kappa=bad)


def test_under_jit_an_error_about_values_is_jax_s():
    simulator, q, target = floating_hand_and_body()
    step = jax.jit(step_jax(simulator))
    with pytest.raises(jax.errors.JaxRuntimeError, match="finite"):
        jax.block_until_ready(step(np.full_like(q, np.nan), target))
