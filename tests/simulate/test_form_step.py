"""The data of a step: what follows from the state, a target and a force, and its bits."""

import copy
import hashlib
import os
import pickle
from itertools import repeat

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.simulate.form_step import form_step
from tests.processes import python

SCENES = 300
H = 0.01
FLOOR = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
SHAPES = (qr.Sphere(0.05), qr.Box((0.05, 0.04, 0.06)), qr.Capsule(0.03, 0.08))
HEIGHTS = (0.05, 0.06, 0.11)
"""Of their centres over the floor on which they stand [m]."""
CLOUD = qr.PointCloud(np.indices((3, 3, 3)).reshape(3, -1).T * 0.04 - 0.04)


def scene(seed):
    """A simulator of a free and a driven body on a floor, and on each other; a target, a force."""
    rng = np.random.default_rng(seed)
    kind, driven_kind = seed % 3, seed // 3 % 3
    place = 0, 0, HEIGHTS[kind]
    bodies = [
        qr.Body.of_shape("free", SHAPES[kind], mass=rng.uniform(0.1, 1), xyz=place),
        qr.Body.of_shape(
            "driven",
            SHAPES[driven_kind],
            mass=1.0,
            base=("floating", "planar")[seed // 9 % 2],
            actuated="all",
            xyz=(0.1, 0.01, HEIGHTS[driven_kind] + 0.002),
        ),
    ]
    system = qr.System(bodies)
    free, driven = system.shapes
    if seed % 2:
        free = qr.PlacedShape("cloud", free.link, np.eye(3), np.zeros(3), CLOUD)
    pairs = [
        qr.ContactPair(
            name, *sides, rng.uniform(0, 1), rng.uniform(0, 0.02), rows=rng.choice([4, 6]), k=k
        )
        for name, sides, k in zip(
            ("floor", "held", "driven"),
            ((FLOOR, free), (free, driven), (FLOOR, driven)),
            (rng.integers(1, 5), 1, rng.integers(1, 5)),
            strict=True,
        )
    ]
    K_q = rng.uniform(50, 500, system.n_a)
    simulator = qr.Simulator(system, pairs, h=H, K_q=K_q, backend="daqp", certify="off")
    state = system.at(system.q_start).plus(1e-3 * rng.normal(size=system.n_v))
    move = np.append(1e-3 * rng.normal(size=system.n_a), np.zeros(system.n_u))
    target = state.plus(move).q[: system.n_q_a]
    return simulator, state, target, rng.normal(size=system.n_v)


def formed(simulator, state, target, force):
    return form_step(
        simulator.plan, state, target, force, simulator.closest_points(state.kinematics)
    )


@pytest.mark.parametrize("seed", range(6))
def test_a_step_has_the_numbers_that_its_parts_say(seed):
    """J by the Jacobians of whole links: nu + omega x r of beta's body less that of alpha's."""
    simulator, state, target, force = scene(seed)
    system = simulator.system
    n_a = system.n_a
    points = simulator.closest_points(state.kinematics)
    step = form_step(simulator.plan, state, target, force, points)

    def motion(link, point):
        J = state.kinematics.J[link]
        arm = point - state.kinematics.t[link]
        return np.vstack([J[:3] + np.cross(J[3:], arm, axis=0), J[3:]])

    contact = 0
    for pair in simulator.pairs:
        for _ in range(pair.n_c):
            beta = motion(pair.beta.link, points.beta[contact])
            alpha = motion(pair.alpha.link, points.alpha[contact])
            nu, omega = np.split(beta - alpha, 2)
            right = np.vstack([nu, points.n[contact] @ omega])
            np.testing.assert_allclose(step.contacts.J[contact], right, rtol=0, atol=1e-14)
            contact += 1
    weight = system.gravity_force(state.q, simulator.gravity)
    weight[:n_a] = 0.0  # it does not act on what is driven
    assert np.array_equal(np.append(step.tau_a, step.tau_u), weight + force)
    assert np.array_equal(step.delta_q_bar_a, system.actuated_difference(state.q, target))
    assert np.array_equal(step.M_u, system.M_u(state.q))
    assert step == step.replace(contacts=copy.copy(step.contacts))  # which checks all numbers


def digest(scenes=SCENES):
    """Of steps of random scenes: their data, and two steps of their simulators."""
    every = hashlib.sha256()
    for seed in range(scenes):
        simulator, state, target, force = scene(seed)
        form = qr.standard_form(formed(simulator, state, target, force))
        arrays = [*form]
        end = state
        for load in repeat(force, 2):
            try:
                result = simulator.step(end, target, load)
            except qr.QuasistaticError as refused:
                every.update(str(refused).encode())
                break
            arrays += [result.q, result.solution.delta_q, result.solution.lam]
            end = result.end
        for array in arrays:
            every.update((array + 0.0).tobytes())
    return every.hexdigest()


def test_steps_of_300_scenes_have_the_same_bits_with_compiled_code_and_without():
    code = "from tests.simulate.test_form_step import digest; print(digest())"
    without = python("-c", code, env=os.environ | {"QUASISTATIC_REF_COMPILED": "0"})
    assert without.stdout.split() == [digest()]


def test_a_copy_and_a_pickle_form_the_same_step_and_a_refusal_changes_nothing():
    simulator, state, target, force = scene(1)
    step = formed(simulator, state, target, force)
    with pytest.raises(qr.StepDataError, match=r"^tau_u: must contain finite"):
        formed(simulator, state, target, np.append(force[:-1], np.nan))
    with pytest.raises(qr.StepDataError, match="must be numbers of shape"):
        formed(simulator, state, target, force[1:])
    with pytest.raises(qr.ModelError, match="q_a"):
        formed(simulator, state, target[1:], force)
    for other in (simulator, copy.deepcopy(simulator), pickle.loads(pickle.dumps(simulator))):
        assert formed(other, other.system.at(state.q), target, force).same_as(step)


def test_two_results_share_no_memory_of_what_their_steps_formed():
    simulator, state, target, force = scene(0)
    first = simulator.step(state, target, force)
    second = simulator.step(first.end, target, force)

    def arrays(result):
        step = result.step
        return result.q, step.tau_u, step.contacts.own, result.solution.delta_q, result.points.phi

    for one, other in zip(arrays(first), arrays(second), strict=True):
        assert not np.shares_memory(one, other)
    assert not first.q.flags.writeable
    assert first.q.base is None
