"""The derivatives of steps against differences of steps, and the mistakes that those would show.

The reference is Richardson's combination of central differences of the simulator's exact step; it
shares nothing with the formulas but the step itself.
"""

from importlib import import_module

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.extension import Extension
from tests.oracles.differences import after, rate, unit, wrong_by
from tests.oracles.pushes import SHAPES, pushed
from tests.tolerances import DIFFERENCE_OF_STEPS, SEEN

KINDS = tuple(SHAPES)
RING = [(a, KINDS[(i + step) % len(KINDS)]) for i, a in enumerate(KINDS) for step in (1, 3)]
"""Each kind of shape first and second, twice; ``validation.make.derivatives`` has all couples."""


@pytest.mark.parametrize("couple", RING, ids="-".join)
def test_derivatives_of_a_push_agree_with_differences(couple):
    i = RING.index(couple)
    rng = np.random.default_rng(i)
    simulator, q, q_bar_a = pushed(rng, *couple, k=4 if i % 2 else 1)
    found = derivatives(simulator, q, q_bar_a)
    assert found.reasons == ()
    assert found.differentiable
    assert max(wrong_by(simulator, q, q_bar_a, found, rng)) <= DIFFERENCE_OF_STEPS


SETTINGS = ("h", "K_q", "mu_v", "mu_omega", "mass")


def other(simulator, name, j, change):
    """A simulator with one parameter changed."""
    parts = {"h": simulator.h, "K_q": simulator.K_q.copy(), "gravity": simulator.gravity}
    pairs, system = list(simulator.pairs), simulator.system
    if name == "h":
        parts["h"] += change
    elif name == "K_q":
        parts["K_q"][j, j] += change
    elif name == "mass":
        system = heavier(system, j, change)
    else:
        fields = {key: getattr(pairs[j], key) for key in ("alpha", "beta", "mu_v", "mu_omega")}
        fields[name] += change
        pair = pairs[j]
        pairs[j] = type(pair)(pair.name, *fields.values(), pair.rows, pair.k)
    return Simulator(system, pairs, **parts, fast=True)


def heavier(system, link, change):
    """The system with another mass of a link, in its URDF's text."""
    bodies = []
    for body in system.bodies:
        text = body.urdf
        if system.links[link].startswith(f"{body.name}/"):
            mass = system.masses[link]
            text = text.replace(_mass_tag(text), f'<mass value="{float(mass + change)!r}"/>')
        bodies.append(type(body)(body.name, text, body.base, body.actuated))
    return type(system)(bodies)


def _mass_tag(text):
    start = text.index("<mass")
    return text[start : text.index(">", start) + 1]


@pytest.mark.parametrize("name", SETTINGS)
def test_derivatives_by_parameters_agree_with_differences(name):
    rng = np.random.default_rng(3)
    simulator, q, q_bar_a = pushed(rng, "ellipsoid", "capsule", k=4)
    found = derivatives(simulator, q, q_bar_a)
    assert found.reasons == ()
    field = {"mass": "dq_dmasses"}.get(name, f"dq_d{name}")
    claimed = getattr(found, field).reshape(12, -1)
    scale = {"h": 1e-6, "K_q": 1e-2, "mu_v": 1e-4, "mu_omega": 1e-6, "mass": 1e-4}[name]
    columns = {"mass": [2], "mu_v": [0, 1], "mu_omega": [0, 1], "K_q": [0, 4]}.get(name, [0])
    for j in columns:
        there = rate(
            lambda t, j=j: after(other(simulator, name, j, t), found.result.q, q, q_bar_a), scale
        )
        assert np.abs(claimed[:, j] - there).max() <= DIFFERENCE_OF_STEPS * np.abs(claimed).max()
    if name == "mass":  # the hand's own mass is borne by its springs
        assert (claimed[:, :2] == 0).all()


@pytest.mark.parametrize(
    ("scenario", "k"), [("bunny_grasp", 60), ("allegro_turn", 40), ("two_finger_pinch", 38)]
)
def test_derivatives_agree_with_differences_in_a_scenario(scenario, k):
    scene = load_scenario(scenario, steps=k, fast=True)
    rng = np.random.default_rng(k)
    simulator, system = scene.simulator(), scene.system
    q = scene.run(progress=False).q[k]
    q = system.integrate(q, 1e-4 * unit(rng, system.n_v))
    q_bar_a = scene.targets((k + 1) * scene.h)
    found = derivatives(simulator, q, q_bar_a)
    assert "dq_dq" not in {name for why in found.reasons for name in why.fields}
    assert max(wrong_by(simulator, q, q_bar_a, found, rng)) <= DIFFERENCE_OF_STEPS


def test_dq_dtau_agrees_with_the_exact_sensitivity_of_the_step():
    from quasistatic_ref.optional.derivatives.step.sensitivity import sensitivity

    simulator, q, q_bar_a = pushed(np.random.default_rng(5), "box", "mesh", k=4)
    found = derivatives(simulator, q, q_bar_a)
    step, solution = found.result.step, found.result.solution
    exact = sensitivity(step, solution.certificate)
    onward = np.linalg.lstsq(
        np.concatenate([exact.tau_a, exact.tau_u], axis=1).T, found.dq_dtau.T, rcond=None
    )[0]
    by_h = onward.T @ exact.h[:, 0]
    assert np.abs(by_h - found.dq_dh).max() <= DIFFERENCE_OF_STEPS * np.abs(found.dq_dh).max()


def frozen_normal(rates_of):
    def frozen(*given):
        rates = rates_of(*given)
        return rates._replace(n=0 * rates.n)

    return frozen


def flat_beta(couples_of):
    """Beta taken for a vertex: its curvature is left out."""

    def flat(couple):
        alpha, beta = couple.features
        return couple._replace(features=(alpha, beta._replace(bend=0 * beta.bend)))

    return lambda *given: [flat(couple) for couple in couples_of(*given)]


def left_out(rates_of):
    """The change itself for how it depends on where it starts: plus or minus the identity."""

    def signs(*given):
        by_first, by_second = rates_of(*given)
        return np.sign(by_first[0, 0]) * np.eye(len(by_first)), np.eye(len(by_second))

    return signs


def frozen_tangents(_):
    return lambda n, d_n: (0 * d_n, 0 * d_n)


MISTAKES = {
    "the normal frozen": ("step_rates.contact_rates", frozen_normal),
    "beta's curvature left out": ("step_rates.couples", flat_beta),
    "(+) not differentiated": ("step_rates.sum_rates", left_out),
    "(-) not differentiated": ("data_rates.difference_rates", left_out),
    "tangents frozen": ("row_rates.tangent_rates", frozen_tangents),
}
"""The function that is replaced, and by what in terms of it."""


@pytest.mark.parametrize(("where", "mistaken"), MISTAKES.values(), ids=MISTAKES)
def test_each_classic_mistake_is_seen(monkeypatch, where, mistaken):
    module, _, name = where.partition(".")
    at = import_module(f"quasistatic_ref.optional.derivatives.{module}")
    monkeypatch.setattr(at, name, mistaken(getattr(at, name)))
    rng = np.random.default_rng(11)
    simulator, q, q_bar_a = pushed(rng, "ellipsoid", "ellipsoid", k=1)
    found = derivatives(simulator, q, q_bar_a)
    assert max(wrong_by(simulator, q, q_bar_a, found, rng)) > SEEN


def test_derivatives_do_not_move_the_simulator():
    simulator, q, q_bar_a = pushed(np.random.default_rng(1))
    before = simulator.step(q, q_bar_a)
    kept = q.copy()
    found = derivatives(simulator, q, q_bar_a)
    assert found.result == before == simulator.step(q, q_bar_a)
    assert (q == kept).all()


def test_an_uncertified_simulator_has_the_same_derivatives():
    exact, q, q_bar_a = pushed(np.random.default_rng(1))
    rough, _, _ = pushed(np.random.default_rng(1), certify="residual")
    one, two = derivatives(exact, q, q_bar_a), derivatives(rough, q, q_bar_a)
    assert np.abs(one.dq_dq - two.dq_dq).max() <= DIFFERENCE_OF_STEPS


def test_the_ellipsoid_and_extensions_are_refused():
    simulator, q, q_bar_a = pushed(np.random.default_rng(1), cone="ellipsoid")
    with pytest.raises(InputError, match="polyhedron"):
        derivatives(simulator, q, q_bar_a)
    simulator, q, q_bar_a = pushed(np.random.default_rng(1), extension=lambda q: Extension((), 0.0))
    with pytest.raises(InputError, match="any function of q"):
        derivatives(simulator, q, q_bar_a)
