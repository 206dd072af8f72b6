"""Slow steps of piles, asked for again and again: each begins where the one before has ended."""

import itertools

import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.optional.coulomb import fixed_point as coulomb
from quasistatic_ref.optional.fixed_point import fixed_point
from quasistatic_ref.optional.stands.slow import FACTOR, SlowGroup


def test_a_clamps_longer_step_begins_at_the_end_of_the_shorter_one(monkeypatch):
    """Balls that push each other apart: what they lack is the same if both begin at s = 0."""
    r = 0.03
    high = r + 2 * r * (2 / 3) ** 0.5
    places = [(0, 0, r), (2 * r, 0, r), (r, 3**0.5 * r, r), (r, r / 3**0.5, high)]
    balls = [qr.Body.of_shape(f"b{i}", qr.Sphere(r), 0.1, xyz=xyz) for i, xyz in enumerate(places)]
    system = qr.System(balls)
    floor = qr.PlacedShape.in_world("floor", qr.HalfSpace(np.array([0.0, 0, 1]), 0.0))
    touching = [(floor, ball) for ball in system.shapes[:3]]
    touching += itertools.combinations(system.shapes, 2)
    pairs = [qr.ContactPair(f"p{i}", *two, 0.1, 0.0, 4, 1) for i, two in enumerate(touching)]
    simulator = qr.Simulator(system, pairs, h=0.05, backend="daqp", certify="off")
    answers, iterates = [], []
    longer = SlowGroup._longer
    for from_zero in (False, True):

        def asked(self, slow, part=None, from_zero=from_zero):
            if part is not None and from_zero:
                return self._slow(FACTOR * slow.T, 0.0 * slow.s, part)
            return longer(self, slow, part)

        counts = []

        def counted(at, s, most, counts=counts):
            end, count = fixed_point(at, s, most)
            counts.append(count)
            return end, count

        monkeypatch.setattr(SlowGroup, "_longer", asked)
        monkeypatch.setattr(coulomb, "fixed_point", counted)
        answers.append(simulator.stands(system.q_start, None, 0.0).rows)
        iterates.append(sum(counts))
    assert iterates[0] < 0.7 * iterates[1]
    for row, right in zip(*answers, strict=True):
        assert row.stands is right.stands is False
        assert row.missing_N == pytest.approx(right.missing_N, rel=1e-9)
        assert row.held_with == right.held_with
