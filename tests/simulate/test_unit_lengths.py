"""A quaternion that is not of length one is refused before anything is computed from it."""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.errors import ModelError

SIDE = 0.1
ANGLE = 0.6
WORDS = r"q\[box/base\]: its quaternion must have length one, not 2; system.normalised\(q\)"


def box_above_floor():
    """A cube of 0.1 m, turned by 0.6 rad about x, its lowest edge above a floor."""
    box = qr.Body.of_shape(
        "box", qr.Box((SIDE / 2, SIDE / 2, SIDE / 2)), mass=1.0, xyz=(0, 0, 0.08)
    )
    system = qr.System([box])
    floor = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
    pairs = (qr.ContactPair("floor", floor, system.shapes[0], mu_v=0.5, mu_omega=0.0, rows=4, k=2),)
    q = system.q_start.copy()
    q[3:7] = [np.sin(ANGLE / 2), 0, 0, np.cos(ANGLE / 2)]
    return system, pairs, q


def at_speed(fast, simulator):
    return qr.FastSimulator(simulator) if fast else simulator


@pytest.mark.parametrize("fast", [False, True])
def test_a_step_from_a_quaternion_of_length_two_is_refused(fast):
    system, pairs, q = box_above_floor()
    simulator = at_speed(fast, qr.Simulator(system, pairs, h=0.01, K_q=np.zeros((0, 0))))
    # The lowest edge lies side (sin a + cos a) / 2 below the centre.
    gap = q[2] - SIDE * (np.sin(ANGLE) + np.cos(ANGLE)) / 2
    for _ in range(2):  # the first compiled step is not taken as the later ones are
        assert simulator.step(q, np.zeros(0)).step.contacts.phi == pytest.approx([gap, gap])
    q[3:7] *= 2
    with pytest.raises(ModelError, match=WORDS):
        simulator.step(q, np.zeros(0))
    again = simulator.step(system.normalised(q), np.zeros(0)).step.contacts.phi
    assert again == pytest.approx([gap, gap])


USES = {
    "kinematics": lambda system, pairs, q: system.kinematics(q),
    "integrate": lambda system, pairs, q: system.integrate(q, np.zeros(6)),
    "difference": lambda system, pairs, q: system.difference(system.q_start, q),
    "start": lambda system, pairs, q: qr.rollout(
        qr.Simulator(system, pairs, h=0.01, K_q=np.zeros((0, 0))), q, np.zeros(0), 1, progress=False
    ),
}


@pytest.mark.parametrize("use", USES)
def test_what_is_computed_from_it_is_refused(use):
    system, pairs, q = box_above_floor()
    q[3:7] *= 2
    with pytest.raises(ModelError, match=WORDS):
        USES[use](system, pairs, q)


@pytest.mark.parametrize("fast", [False, True])
def test_a_target_of_an_actuated_base_is_refused(fast):
    hand = qr.Body.of_shape("hand", qr.Sphere(0.05), mass=1.0, actuated="all")
    system = qr.System([hand])
    simulator = at_speed(fast, qr.Simulator(system, (), h=0.01, K_q=np.eye(6)))
    q = system.q_start
    simulator.step(q, q)
    with pytest.raises(ModelError, match=r"q\[hand/base\]: its quaternion must have length one"):
        simulator.step(q, np.concatenate([q[:3], 2 * q[3:]]))
