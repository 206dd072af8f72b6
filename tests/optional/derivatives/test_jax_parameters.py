"""Steps as functions of JAX by friction, stiffness, time step and masses; and NaN at kinks."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from quasistatic_ref import (
    Body,
    Box,
    ContactPair,
    InputError,
    Simulator,
    Sphere,
    System,
    step_jax,
)
from quasistatic_ref.optional.derivatives import entries
from tests.closeness import assert_same, assert_within
from tests.contact.still import placed_shape
from tests.extras import reason as needs
from tests.optional.derivatives.free_bodies import FLOOR, NONE, falling_ball
from tests.tolerances import JAX_GRADIENT, JAX_STEP

jax = pytest.importorskip("jax", reason=needs("jax"))
pytestmark = pytest.mark.extra("jax")
check_grads = import_module("jax.test_util").check_grads
OWN = {
    "mu_v": np.array([0.4, 0.2]),
    "mu_omega": np.array([0.002, 0.001]),
    "K_q": np.array([900.0, 1100.0, 8.0]),
    "h": np.array([0.02]),
    "masses": np.array([0.0, 0.1, 0.5]),
}
"""Of a finger and the box that it pushes over a floor."""
OTHER = {name: value * np.linspace(1.1, 0.8, len(value)) for name, value in OWN.items()}
NAMES = [*OWN]
TARGET = np.array([-0.0485, 0.004, 0.8, 0.6])


def pushing(mu_v, mu_omega, K_q, h, masses):
    """A finger in the plane, which pushes a box off its centre; each body is made of its mass."""
    inertias = 0.1 * (2 / 5) * 0.01**2, 0.5 * 0.05**2 / 6
    finger = made("finger", Sphere(0.01), masses[1], inertias[0], (-0.0605, 0.012, 0.02), "planar")
    finger = replace(finger, actuated=("base",))
    box = made("box", Box((0.05, 0.05, 0.02)), masses[2], inertias[1], (0, 0, 0.02), "floating")
    system = System([finger, box])
    tip, side = (next(s for s in system.shapes if s.name.startswith(n)) for n in ("finger", "box"))
    pairs = [
        ContactPair("floor", placed_shape(FLOOR), side, mu_v[0], mu_omega[0], 6, 4),
        ContactPair("push", tip, side, mu_v[1], mu_omega[1], 6),
    ]
    K = np.diag(K_q)
    K[0, 1] = K[1, 0] = 30.0
    return Simulator(system, pairs, h=h[0], K_q=K, backend="daqp")


def made(name, shape, mass, moment, xyz, base):
    """A body of one link, whose inertia does not go with its mass."""
    size = (
        f'<box size="{" ".join(str(2 * a) for a in shape.half_extents)}"/>'
        if isinstance(shape, Box)
        else f'<sphere radius="{shape.radius}"/>'
    )
    moments = " ".join(f'{axis}="{moment}"' for axis in ("ixx", "iyy", "izz"))
    inertia = f'<mass value="{mass}"/><inertia {moments} ixy="0" ixz="0" iyz="0"/>'
    urdf = (
        f'<robot name="r"><link name="{name}"><inertial>{inertia}</inertial>'
        f"<collision><geometry>{size}</geometry></collision></link></robot>"
    )
    return Body(name, urdf, base, xyz=xyz)


@pytest.fixture(autouse=True)
def in_float64():
    """In all threads: batches are computed in those of JAX."""
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", before)


@pytest.mark.parametrize("names", [*((name,) for name in NAMES), tuple(NAMES)], ids="-".join)
@pytest.mark.parametrize("how", [lambda step: step, jax.jit], ids=["alone", "jit"])
def test_a_step_by_parameters_has_the_bits_of_a_simulator_that_is_made_of_them(names, how):
    simulator = pushing(**OWN)
    step = how(step_jax(simulator, by=names))
    q = simulator.system.q_start
    values = {name: OTHER[name] for name in names}
    assert_same(step(q, TARGET), simulator.step(q, TARGET).q)
    expected = pushing(**OWN | values).step(q, TARGET).q
    assert_same(step(q, TARGET, **values), expected)
    changes = not np.array_equal(expected, simulator.step(q, TARGET).q)
    assert changes == (names != ("mu_omega",))  # nothing spins


@pytest.mark.parametrize("name", NAMES)
def test_gradients_by_parameters_pass_the_check_of_jax(name):
    simulator = pushing(**OWN)
    step = step_jax(simulator, by=name)
    q = simulator.system.q_start
    size = OWN[name] if name != "masses" else np.ones(2)

    def of(share):
        value = size * share
        if name == "masses":  # the world's stays
            value = OWN[name] * jax.numpy.concatenate([jax.numpy.ones(1), share])
        return step(q, TARGET, **{name: value})

    for function in (of, jax.jit(of)):
        given = (np.ones(len(size)),)
        check_grads(
            function, given, 1, ("fwd", "rev"), atol=JAX_GRADIENT, rtol=JAX_GRADIENT, eps=JAX_STEP
        )


def test_scan_and_vmap_take_parameters():
    """The slope of a run by mu_v and K_q, of several at once; each is that of one alone."""
    simulator = pushing(**OWN)
    step = step_jax(simulator, by=("mu_v", "K_q"))
    q = jax.numpy.asarray(simulator.system.q_start)
    targets = TARGET + np.array([1e-3, 0, 0, 0]) * np.arange(3)[:, None]

    def run(mu_v, K_q):
        def one(q, target):
            return (step(q, target, mu_v=mu_v, K_q=K_q),) * 2

        return jax.lax.scan(one, q, targets)[1][:, 4:7]

    check_grads(
        run, (OWN["mu_v"], OWN["K_q"]), 1, ("fwd", "rev"), atol=1e-5, rtol=1e-5, eps=JAX_STEP
    )
    several = np.array([OWN["mu_v"], OTHER["mu_v"]])
    by_each = jax.vmap(jax.jacfwd(run), (0, None))(several, OWN["K_q"])
    for each, mu_v in zip(by_each, several, strict=True):
        assert_within(each, jax.jacrev(run)(mu_v, OWN["K_q"]), JAX_GRADIENT)


def test_a_simulator_of_other_parameters_is_made_once_for_the_same(monkeypatch):
    made = []
    of = entries.with_parameters
    monkeypatch.setattr(entries, "with_parameters", lambda *args: made.append(1) or of(*args))
    simulator = pushing(**OWN)
    step = step_jax(simulator, by=NAMES)
    q = simulator.system.q_start
    for _ in range(3):
        jax.jacrev(lambda mu: step(q, TARGET, mu_v=mu))(OWN["mu_v"])
    assert len(made) == 1
    for k in range(2 * entries.KEPT):
        step(q, TARGET, mu_v=OWN["mu_v"] * (1 + 1e-3 * k))
    step(q, TARGET)
    assert len(made) == 2 * entries.KEPT + 1


@pytest.mark.parametrize("how", [lambda slope: slope, jax.jit], ids=["alone", "jit"])
def test_with_nan_a_kink_is_nan_in_its_own_columns_alone(how):
    """A ball that just reaches the floor: by its height alone, and by h, it has no slope."""
    simulator, q = falling_ball()
    step = step_jax(simulator, by=("h", "mu_v"), kinks="nan")
    by_q = how(jax.jacrev(lambda q: step(q, NONE)))(q)
    assert np.isnan(by_q[:, 2]).all()
    assert np.isfinite(np.delete(by_q, 2, axis=1)).all()
    assert_within(np.isnan(how(jax.jacfwd(lambda q: step(q, NONE)))(q)), np.isnan(by_q), 0)
    by_h = how(jax.jacrev(lambda h: step(q, NONE, h=h)))(0.01)
    assert np.isnan(by_h).all()
    by_mu_v = how(jax.jacrev(lambda mu: step(q, NONE, mu_v=mu)))(0.5)
    assert_same(by_mu_v, np.zeros(7))
    assert_same(how(step)(q, NONE), simulator.step(q, NONE).q)


def test_with_nan_one_kink_of_a_batch_loses_no_other_slope():
    simulator, q = falling_ball()
    step = step_jax(simulator, kinks="nan")
    heights = np.stack([q + 1e-4 * k * np.eye(7)[2] for k in (-1, 0, 1)])
    slope = jax.jit(jax.vmap(jax.grad(lambda q: step(q, NONE)[2])))(heights)
    assert_within(slope[::2, 2], [0.0, 1.0], JAX_GRADIENT)
    assert np.isnan(slope[1, 2])
    assert np.isfinite(np.delete(slope, 2, axis=1)).all()


def test_with_nan_steps_after_a_kink_have_no_slope_either_and_are_there():
    simulator, q = falling_ball()
    step = step_jax(simulator, kinks="nan")

    def twice(q):
        return step(step(q, NONE), NONE)

    assert np.isnan(jax.jvp(twice, (q,), (np.eye(7)[2],))[1]).all()
    assert np.isfinite(twice(q)).all()


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"by": "mass"}, "by: must be some of mu_v, mu_omega, K_q, h, masses"),
        ({"by": ("h", "h")}, "each once"),
        ({"by": "q"}, "by: must be some of"),
        ({"kinks": "zero"}, "kinks: must be error or nan"),
    ],
)
def test_names_of_step_jax_are_checked(settings, says):
    with pytest.raises(InputError, match=says):
        step_jax(pushing(**OWN), **settings)


def test_parameters_of_the_function_are_checked():
    simulator = pushing(**OWN)
    step = step_jax(simulator, by=("mu_v", "masses"))
    q = simulator.system.q_start
    with pytest.raises(InputError, match="is not taken; name it in step_jax"):
        step(q, TARGET, K_q=OWN["K_q"])
    with pytest.raises(InputError, match=r"mu_v: must have shape \(2,\)"):
        step(q, TARGET, mu_v=0.5)
    for name, value in (
        ("mu_v", [-0.1, 0.2]),
        ("masses", [1.0, 0.1, 0.5]),
        ("masses", [0, 0.1, -1]),
    ):
        with pytest.raises(Exception, match="must") as error:
            step(q, TARGET, **{name: np.array(value, float)})
        assert type(error.value).__module__.startswith("quasistatic_ref")
