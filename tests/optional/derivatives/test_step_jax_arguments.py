"""What steps in JAX and derivatives are asked with: the checks of ``Simulator.step``."""

import numpy as np
import pytest

import quasistatic_ref as qr
from tests.extras import reason as needs

jax = pytest.importorskip("jax", reason=needs("jax"))


@pytest.fixture(autouse=True)
def in_float64():
    with jax.enable_x64(True):
        yield


@pytest.fixture(scope="module")
def push():
    """A ball that pushes a block: simulator, q and target."""
    finger = qr.Body.of_shape(
        "finger", qr.Sphere(0.01), mass=0.1, xyz=(-0.06, 0, 0.02), actuated=["base"]
    )
    block = qr.Body.of_shape("block", qr.Box((0.05, 0.05, 0.02)), mass=0.5, xyz=(0, 0, 0.02))
    K_q = {"base": [1000, 1000, 1000, 10, 10, 10]}
    scenario = qr.load_scenario({
        "h": 0.05,
        "steps": 5,
        "bodies": {"finger": {"urdf": finger, "K_q": K_q}, "block": block},
        "shapes": {"floor": qr.HalfSpace((0, 0, 1), 0.0)},
        "contacts": {
            "floor": {"alpha": "floor", "beta": "block", "mu_v": 0.3, "rows": 4, "k": 4},
            "push": {"alpha": "finger", "beta": "block", "mu_v": 0.2, "rows": 4},
        },
    })  # fmt: skip
    q = scenario.system.q_start
    return scenario.simulator(), q, q[:7] + 0.005 * np.eye(7)[0]


WRONG = {
    "a number": lambda q, target: (q, target, 0.5),
    "one entry": lambda q, target: (q, target, np.array([0.5])),
    "seven entries": lambda q, target: (q, target, np.zeros(7)),
    "a batch": lambda q, target: (np.stack([q, q]), np.stack([target, target])),
    "a short target": lambda q, target: (q, target[:6]),
}


@pytest.mark.parametrize("wrong", WRONG)
@pytest.mark.parametrize("how", ["alone", "jit", "grad"])
def test_arguments_have_the_shapes_of_simulator_step(push, wrong, how):
    simulator, q, target = push
    step = qr.step_jax(simulator)
    arguments = WRONG[wrong](q, target)
    with pytest.raises(qr.InputError):
        simulator.step(*arguments)

    def asked(x):
        return step(x, *arguments[1:])[0]

    ways = {"alone": asked, "jit": jax.jit(asked), "grad": jax.grad(lambda x: asked(x).sum())}
    with pytest.raises(qr.InputError, match=r"must have shape .*jax\.vmap"):
        ways[how](jax.numpy.asarray(arguments[0]))


def test_a_batch_goes_through_vmap(push):
    simulator, q, target = push
    both = jax.vmap(qr.step_jax(simulator))(np.stack([q, q]), np.stack([target, target]))[0]
    np.testing.assert_array_equal(both, [simulator.step(q, target).q] * 2)


def test_whole_numbers_are_numbers_and_float32_is_named(push):
    simulator, q, target = push
    step = qr.step_jax(simulator)
    force = 3 * np.arange(12)
    np.testing.assert_array_equal(step(q, target, force)[0], simulator.step(q, target, force).q)
    np.testing.assert_array_equal(step(q, target, 0)[0], simulator.step(q, target).q)
    smooth = qr.smoothed_jax(simulator)
    np.testing.assert_array_equal(smooth(q, target, 1)[0], smooth(q, target, 1.0)[0])
    with pytest.raises(qr.InputError, match=r"q: must be float64; make it so .*float32"):
        step(q.astype(np.float32), target)
    with pytest.raises(qr.InputError, match="kappa: must be float64; make it so"):
        smooth(q, target, np.float32(1e-6))
    with jax.enable_x64(False), pytest.raises(qr.InputError, match="jax_enable_x64"):
        step(q, target)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -1.0, True, "1e-9", [1e-9, 1e-9]])
def test_what_is_no_weight_and_no_distance_is_refused(push, bad):
    simulator, q, target = push
    with pytest.raises(qr.InputError, match="kappa"):
        qr.smoothed(simulator, q, target, bad)
    with pytest.raises(qr.InputError, match="nearly"):
        qr.derivatives(simulator, q, target, nearly=bad)
    with pytest.raises(qr.InputError, match="nearly"):
        qr.step_jax(simulator, nearly=bad)
    with pytest.raises(qr.InputError, match="kappa"):
        qr.step_jax(simulator, "smoothed", kappa=bad)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_directions_are_finite_and_have_the_shapes_of_the_fields(push, bad):
    derivatives = qr.derivatives(*push)
    for ask in (derivatives.along, derivatives.reach_along):
        with pytest.raises(qr.InputError, match=r"q_bar_a: must contain finite"):
            ask(q_bar_a=np.full(6, bad))
        with pytest.raises(qr.InputError, match=r"tau: must have shape \(12,\)"):
            ask(tau=np.ones((1, 12)))


def test_under_jit_an_error_about_values_is_jax_s(push):
    simulator, q, target = push
    step = jax.jit(qr.step_jax(simulator))
    with pytest.raises(jax.errors.JaxRuntimeError, match="finite"):
        jax.block_until_ready(step(np.full_like(q, np.nan), target))
