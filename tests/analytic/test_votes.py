"""Which way a pushed slider turns, by Mason's voting theorem (1986): cones.md says where it holds.

Its support presses with any distribution and isotropic friction. Three rays leave the point that
is pushed: the pusher's way, and both edges of its friction cone. The side of the middle on which
two of them pass is the one to which the slider turns.
"""

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.lab.made_steps.slider import Push, push_step, rotated, turned

FAR = 0.05
"""From the middle to the side that is pushed [m]."""
WAY = 2e-3
"""Of the pusher in a step [m]."""


def pushes(count):
    """Random pushes at (gap 0, at rest): the step, and the sign of the turn by the theorem."""
    rng = np.random.default_rng(0)
    for _ in range(count):
        normal = rotated(np.array([1.0, 0.0]), rng.uniform(0, 2 * np.pi))
        point = -FAR * normal + rng.uniform(-0.03, 0.03) * turned(normal)
        mu, chi = rng.uniform(0.1, 0.6), rng.uniform(0.02, 0.04)
        way = rotated(normal, rng.uniform(-0.8, 0.8))
        edges = [normal + sign * mu * turned(normal) for sign in (1, -1)]
        votes = [np.sign(turned(point) @ ray) for ray in (way, *edges)]
        of = Push(point, normal, mu, 0.3, 0.3 * chi, 0.0, np.zeros(3), 0.0, 0.0, np.zeros(2))
        yield push_step(of).replace(h=0.1, delta_q_bar_a=WAY * way), np.sign(sum(votes))


@pytest.mark.parametrize(("cone", "wrong"), [("ellipsoid", 0), ("pyramid", 8)])
def test_the_pyramid_turns_some_pushed_bodies_the_wrong_way(cone, wrong):
    ways = [(qr.solve_step(s.replace(cone=cone)).delta_q[5], turn) for s, turn in pushes(100)]
    assert min(abs(omega) for omega, _ in ways) > 1e-9
    assert sum(omega * turn < 0 for omega, turn in ways) == wrong
