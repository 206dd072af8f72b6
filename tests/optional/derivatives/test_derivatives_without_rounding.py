"""Derivatives against differences of steps without rounding: a sample of random states.

``validation.make.derivative_states`` has thousands, and a table.
"""

import json

import numpy as np
import pytest
from flint import fmpq

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.vectors.distances.shapes import placed
from quasistatic_ref.lab.vectors.distances.solid_pair import pair_witness
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.precision import rational_near
from quasistatic_ref.lab.vectors.families.derivative_pairs import shape_of
from quasistatic_ref.lab.vectors.families.mechanisms import random_quaternion
from quasistatic_ref.lab.vectors.whole.grid import working
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.derivatives import step_rates as module
from quasistatic_ref.optional.derivatives.derivatives import derivatives
from quasistatic_ref.optional.derivatives.step.reason import TANGENTS
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud, Sphere
from quasistatic_ref.simulate.simulator import Simulator
from tests.oracles.gradients.closest import closest_pair
from tests.oracles.gradients.reference import reference, slope
from tests.oracles.gradients.states import table_of, whole_state
from tests.tolerances import SEEN
from validation.make.derivative_states import WITHIN, error, page, record, records

STATES = (3, 5, 9, 14, 16, 24, 46, 53, 88, 112, 675)
"""Pushes, pairs, crowds, mechanisms and two scenarios; cones and ellipsoids among themselves; rims
of two cylinders near contact."""
GRID = fmpq(1, 1 << 300)
"""Of numbers that two methods have on multiples of 2^-320."""


@pytest.mark.parametrize("i", STATES)
def test_a_random_state_agrees_with_differences_without_rounding(i):
    found = record(i)
    assert error(found) <= WITHIN
    assert found["kinks"] == []
    assert len(found["fields"]) >= 4


@pytest.mark.parametrize("side", [0.0, 1.0, 2.6, 2.75, 3.0, 6.0])
def test_tangents_that_switch_are_named_only_where_the_step_feels_it(side):
    # A point on a ball where the axes x and y are as far from the normal, (1, 1, 2) / sqrt(6). The
    # cosine between both d1 is -1/5, so that a force along the one is inside of the other's pyramid
    # up to mu N / (1/5 + sqrt(24)/5); inside of its own alone up to mu N, and beyond it slides.
    # N is the push of 6 and what lifts 0.3 kg by 1e-4 in 0.01 s, 0.3.
    up = np.array([1.0, 1.0, 2.0]) / np.sqrt(6)
    along = np.array([5.0, -1.0, -2.0]) / np.sqrt(30)
    limit = 0.5 * 6.3 / (0.2 + np.sqrt(0.96))
    system = System([Body.of_shape("body", Sphere(0.05), 0.3)])
    here = np.eye(3), np.zeros(3)
    point = PlacedShape("body", system.link("body"), *here, PointCloud(np.zeros((1, 3))))
    pair = ContactPair("c0", PlacedShape("ball", 0, *here, Sphere(0.05)), point, 0.5, 0.01, 6, 1)
    simulator = Simulator(system, [pair], h=0.01, K_q=np.zeros((0, 0)))
    q = np.concatenate([0.0499 * up, [0.0, 0.0, 0.0, 1.0]])
    weightless = np.array([0.0, 0.0, 0.3 * 9.81])
    force = np.concatenate([weightless - 6 * up + side * along, np.zeros(3)])
    found = derivatives(simulator, q, np.zeros(0), force)
    state = whole_state("", "", simulator, table_of(simulator), q, np.zeros(0), force)
    one = reference(state)
    slopes = [slope(one, "dq_dq", e) for e in np.eye(6)]
    smooth = all(is_smooth for _, is_smooth in slopes)
    assert {why.kind for why in found.reasons} == (set() if smooth else {TANGENTS})
    assert smooth == (side < limit)
    if smooth:
        there = np.column_stack([column for column, _ in slopes])
        assert np.abs(found.dq_dq - there).max() <= WITHIN


def test_a_frozen_normal_is_seen(monkeypatch):
    rates_of = module.contact_rates

    def frozen(couples, tangents, J):
        found = rates_of(couples, tangents, J)
        return found._replace(n=0 * found.n)

    monkeypatch.setattr(module, "contact_rates", frozen)
    assert error(record(112)) > SEEN


@pytest.mark.parametrize(
    "kinds",
    [("box", "box"), ("convex", "box"), ("capsule", "convex"), ("box", "ellipsoid"),
     ("cylinder", "cone"), ("capsule", "cylinder"), ("ellipsoid", "cylinder"), ("convex", "cone")],
)  # fmt: skip
def test_closest_points_by_newton_are_those_of_the_closed_forms(kinds):
    for seed in range(3):
        rng = np.random.default_rng([seed, 19])
        way = rng.normal(size=3)
        places = [
            {"xyz": (x * way / np.linalg.norm(way)).tolist(), "quaternion": random_quaternion(rng)}
            for x in (0.0, 0.3)
        ]
        a, b = (placed(shape_of(rng, k), p) for k, p in zip(kinds, places, strict=True))
        with working():
            exact = pair_witness(a, b)
            ends = [_float64(x) for x in (exact.alpha, exact.beta, exact.n)]
        found = closest_pair(a, b, Witness(_float64([exact.phi])[0], *ends, True))
        assert abs(rational_near(found.phi) - rational_near(exact.phi)) < GRID
        for mine, theirs in ((found.alpha, exact.alpha), (found.n, exact.n)):
            assert all(abs(rational_near(x) - rational_near(y)) < GRID
                       for x, y in zip(mine, theirs, strict=True))  # fmt: skip


def _float64(values):
    return [fmpq(*float(x).as_integer_ratio()) for x in map(rational_near, values)]


def test_a_run_goes_on_from_its_log(tmp_path):
    log = tmp_path / "states.log"
    first = list(records(2, log))
    lines = log.read_text().splitlines()
    assert [json.loads(line) for line in lines] == json.loads(json.dumps(first))
    wrong = {**first[1], "fields": {"dq_dh": [1.0, 1.0, 1.0, 1]}}
    log.write_text(f"{lines[0]}\n{json.dumps(wrong)}\n")
    again = list(records(2, log))
    assert error(again[1]) == 1.0
    fields = {name: [0.0, 1.0, 1.0, 2] for name in first[0]["fields"]}
    text = page([{**first[0], "fields": fields}, again[1]], {"no step": 3})
    assert "1 with an error above 1e-09; 0 in which" in text
    assert text.count(": an error of 1.0e+00.") == 1
    assert "3 with no step" in text
