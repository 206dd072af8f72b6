"""The derivatives of steps against differences of steps, and the mistakes that those would show.

The reference is Richardson's combination of central differences of the simulator's exact step; it
shares nothing with the formulas but the step itself.
"""

import numpy as np
import pytest

from quasistatic_ref import load_scenario
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.scenes.pushes import pushed
from quasistatic_ref.optional.derivatives import step_rates as module
from quasistatic_ref.optional.derivatives.contact.contact_rates import ContactRates
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.extension import Extension
from tests.tolerances import DIFFERENCE_OF_STEPS, SEEN
from validation.make.derivatives import COUPLES, after, rate, unit, wrong_by


@pytest.mark.parametrize("couple", COUPLES, ids="-".join)
def test_derivatives_of_a_push_agree_with_differences(couple):
    i = COUPLES.index(couple)
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


def frozen_normal(rates):
    return rates._replace(n=0 * rates.n)


def flat(side):
    """The couples with one body taken for a vertex: its curvature is left out."""

    def changed(couples):
        return [
            c._replace(
                features=tuple(
                    f._replace(bend=0 * f.bend) if i == side else f
                    for i, f in enumerate(c.features)
                )
            )
            for c in couples
        ]

    return changed


def material(rates, simulator, motion, points):
    """Closest points that move with their bodies."""
    ends = []
    for links, at in (
        (simulator.layout.link_alpha, points.alpha),
        (simulator.layout.link_beta, points.beta),
    ):
        J = motion.J[links]
        ends.append(J[:, :3] + np.cross(J[:, 3:], at[:, :, None], axis=1))
    return rates._replace(alpha=ends[0], beta=ends[1])


MISTAKES = (
    "the normal frozen",
    "alpha's curvature left out",
    "beta's curvature left out",
    "contact points taken as material",
    "the world's axes in place of the body's",
    "(+) not differentiated",
    "(-) not differentiated",
    "tangents frozen",
)


@pytest.mark.parametrize("mistake", [None, *MISTAKES])
def test_each_classic_mistake_is_seen(monkeypatch, mistake):
    rng = np.random.default_rng(11)
    simulator, q, q_bar_a = pushed(rng, "ellipsoid", "ellipsoid", k=1)
    rates_of, couples_of = module.contact_rates, module.couples

    def rates(couples, tangents, J) -> ContactRates:
        found = rates_of(couples, tangents, J)
        if mistake == "the normal frozen":
            return frozen_normal(found)
        if mistake == "contact points taken as material":
            kinematics = simulator.system.kinematics(q)
            motion = module.MotionRates(kinematics, simulator.system.motion)
            points = simulator.closest_points(kinematics)
            return material(found, simulator, motion, points)
        return found

    monkeypatch.setattr(module, "contact_rates", rates)
    sides = {"alpha's curvature left out": 0, "beta's curvature left out": 1}
    if mistake in sides:
        monkeypatch.setattr(module, "couples", lambda *a: flat(sides[mistake])(couples_of(*a)))
    n_v, n_a = simulator.system.n_v, simulator.system.n_a
    if mistake == "(+) not differentiated":
        monkeypatch.setattr(module, "sum_rates", lambda *a: (np.eye(n_v), np.eye(n_v)))
    if mistake == "(-) not differentiated":
        there = "quasistatic_ref.optional.derivatives.data_rates.difference_rates"
        monkeypatch.setattr(there, lambda *a: (-np.eye(n_a), np.eye(n_a)))
    if mistake == "tangents frozen":
        there = "quasistatic_ref.optional.derivatives.row_rates.tangent_rates"
        monkeypatch.setattr(there, lambda n, d_n: (0 * d_n, 0 * d_n))
    found = derivatives(simulator, q, q_bar_a)
    direction = unit(rng, n_v)
    claimed = found
    if mistake == "the world's axes in place of the body's":
        R = simulator.system.kinematics(q).R[[1, 2]]
        axes = np.zeros((12, 12))
        for at, block in enumerate((R[0], R[0], R[1], R[1])):
            axes[3 * at : 3 * at + 3, 3 * at : 3 * at + 3] = block
        claimed = _Claim(found.result, found.dq_dq @ axes.T, found.dq_dq_bar_a)
    wrong = max(wrong_by(simulator, q, q_bar_a, claimed, rng, direction))
    assert wrong <= DIFFERENCE_OF_STEPS if mistake is None else wrong > SEEN


class _Claim:
    def __init__(self, result, dq_dq, dq_dq_bar_a):
        self.result, self.dq_dq, self.dq_dq_bar_a = result, dq_dq, dq_dq_bar_a


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
