"""Rows that touch and bear load, and nearly do, so that a derivative would be wrong: (R41)."""

from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref import derivatives, load_scenario
from quasistatic_ref.optional.derivatives.gradient import combined, directed
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.step.nearly import nearly_weak
from quasistatic_ref.optional.derivatives.step.optimum_rates import DataRates, Equations
from quasistatic_ref.optional.derivatives.step.touching import (
    BEARING,
    Touching,
    bearing,
    touching_rows,
)
from quasistatic_ref.optional.derivatives.step_rates import StepRates
from quasistatic_ref.optional.derivatives.tolerances import CONSISTENT, NEARLY
from quasistatic_ref.tolerances import FILLED
from tests.closeness import assert_within
from tests.helpers import point_on_floor
from tests.optional.derivatives.free_bodies import (
    BOX,
    FLOOR,
    NONE,
    POINT,
    G,
    H,
    falling_ball,
    free,
    verdict,
)
from tests.oracles.differences import after

W = 0.3 * G
X, _, Z = np.eye(6)[:3]


@pytest.mark.parametrize("gap", [3e-14, -3e-14])
def test_a_ball_that_nearly_reaches_the_floor_has_derivatives_on_both_sides(gap):
    """Above the floor it falls on, below it its load is 3e-14 m times m / h^2."""
    simulator, q = falling_ball(gap)
    found, kinds = verdict(simulator, q)
    assert BEARING < abs(gap) / (H**2 * G) < NEARLY
    assert kinds == {reason.NEARLY}
    assert "settled: nearly a kink at row +d1 of c0/0" in {why.sentence for why in found.reasons}
    assert len(found.reasons) == 6
    assert np.isnan(found.dq_dq[:, 2]).all()
    for way, slope in ((Z, 1.0), (-Z, 0.0)):
        assert_within(found.along(q=way)[2], slope * way[2])
        one = derivatives(simulator, q, NONE, towards={"q": way})
        assert_within(one.dq_dq[2, 2], slope)
    exact = derivatives(simulator, q, NONE, nearly=0.0)
    assert exact.differentiable
    assert_within(exact.dq_dq[2, 2], float(gap > 0))


@pytest.mark.parametrize("gap", [-1e-15, -1e-17])
def test_a_ball_whose_load_is_rounding_is_at_the_kink(gap):
    simulator, q = falling_ball(gap)
    found, kinds = verdict(simulator, q)
    assert kinds == {reason.WEAK}
    assert found.result.solution.lam.any()


@pytest.mark.parametrize(("spare", "near"), [(1e-10, True), (1e-6, False)])
def test_a_point_that_nearly_slides_is_at_a_kink_of_all_rows_but_one(spare, near):
    """It is pushed along x by mu W (1 - spare): all of its load but that share is on row -d1."""
    simulator, q = free(POINT, (0, 0, 0), FLOOR, mu=(0.5, 0.0))
    found, kinds = verdict(simulator, q, 0.5 * W * (1 - spare) * X)
    assert kinds - {reason.ZERO_FRICTION} == ({reason.NEARLY} if near else set())
    rows = {why.where[1] for why in found.reasons if why.kind == reason.NEARLY}
    assert rows <= {"+d1", "+d2", "-d2", "+spin", "-spin"}
    assert ("+d1" in rows) == near
    assert np.isnan(found.dq_dtau[:, 0]).any() == near


def test_a_settled_grasp_is_nearly_at_a_kink_and_has_a_derivative_on_each_side():
    """The derivative of its own side is wrong by about one on the other, 1e-11 away."""
    scenario = load_scenario("bunny_grasp", steps=60, fast=True)
    simulator = scenario.simulator()
    q = scenario.run().q[59]
    target = scenario.targets(60 * scenario.h)
    found = derivatives(simulator, q, target)
    assert {why.kind for why in found.reasons} == {reason.NEARLY}
    own = derivatives(simulator, q, target, nearly=0.0)
    assert own.differentiable
    way = np.eye(simulator.system.n_v)[0]
    eps = 1e-7
    wrong = []
    for e in (way, -way):
        there = simulator.system.integrate(q, eps * e)
        change = after(simulator, found.result.q, there, target) / eps
        assert_within(found.along(q=e), change, 1e-5)
        wrong.append(np.abs(own.dq_dq @ e - change).max())
    assert max(wrong) > 1


SMALL = 1e-2
"""How far a force goes, over the change for which rows are named: the angles between rows, which
(R41) leaves out, are larger."""


def weak_rows(simulator, q, force, way, change):
    """The rows that touch, and those that a change along a way would nearly make weak."""
    result = simulator.step(q, NONE, force)
    rates = StepRates(simulator, q, result)
    equations = Equations(touching_rows(result.solution, rates.far))
    one = combined(rates.data, directed(rates.places, {"tau": way}, "way"))
    named = nearly_weak(equations, equations.rates(one), one, np.array([change]))
    touching = {(int(j), int(i)) for j, i in (*equations.of.strict, *equations.of.idle)}
    return touching, {(int(j), int(i)) for j, i in named}


@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.long) for k in (1, 2))])
def test_r41_rows_that_a_small_force_changes_are_named(seed):
    """Of a block on its corners, whose steps are linear in the force piece by piece."""
    rng = np.random.default_rng(seed)
    simulator, q = free(BOX, (0, 0, 0.05), FLOOR, k=4, mu=(0.4, 0.01))
    arms = np.array([1.0, 1.0, 1.0, 0.05, 0.05, 0.05])
    changed = spared = 0
    for _ in range(60):
        force, way = W * arms * rng.normal(size=(2, 6))
        change = 10.0 ** rng.uniform(-3, 1)
        before, named = weak_rows(simulator, q, force, way, change)
        for sign in (1, -1):
            after, _ = weak_rows(simulator, q, force + sign * SMALL * change * way, way, change)
            assert before ^ after <= named
            changed += bool(before ^ after)
            spared += bool(before - named)
    assert min(changed, spared) > 3


@pytest.mark.parametrize("unit", [1.0, 2.0**100, 2.0**-100])
def test_rows_touch_and_bear_under_load_whatever_the_unit_of_mass(unit):
    """A point on a slope: one row bears all load, another a share of it that is rounding.

    Both touch, though the gap is more than rounding; and nothing bears where it stands for nothing.
    """
    W = 3.0 * unit
    lam = H * W * np.array([BEARING / 1000, 0.0, 1.0, 0.0])
    for phi, n_open in ((1e-9, 2), (FILLED, 0)):
        step = point_on_floor(0.3 * unit, 0.5, phi, (0.5 * W, 0.0, -W), H)
        answer = SimpleNamespace(step=step, delta_q=np.zeros(3), lam=lam)
        found = touching_rows(answer, np.zeros(1))
        assert (found.strict.tolist(), found.idle.tolist()) == ([[0, 2]], [[0, 0]])
        assert len(found.open) == n_open
        loose = found.unloaded(np.array([[0, 2], [0, 0]]))
        assert (loose.strict.tolist(), sorted(loose.idle.tolist())) == ([], [[0, 0], [0, 2]])


def test_a_row_in_the_span_of_those_that_bear_load_bears_it_too():
    """(1, 0) is 50 times h_1 + h_2: it takes 1/50 of their load at most, which is not nothing."""
    rows = np.array([[0.01, 1.0], [0.01, -1.0], [1.0, 0.0]])
    rows /= np.linalg.norm(rows, axis=1)[:, None]
    assert bearing(rows, np.array([2.0, 2.0, 0.0]), 1 / BEARING).all()


@pytest.mark.parametrize("n_strict", [1, 2])
def test_a_wall_forbids_no_motion_of_its_like_by_rounding(n_strict):
    """Walls x >= 0 and 3 x >= 0: a load of 2 along x is what they take.

    The second bears load or none, and moves off by less than the rounding of `terms`.
    """
    generators = np.zeros((2, 4, 2))
    motion = np.zeros((2, 4, 1))
    generators[:, 0, 0] = 1.0, 3.0
    both = np.array([[0, 0], [1, 0]])
    rows = both[:n_strict], both[n_strict:], np.zeros((2, 1)), both[:0], np.zeros(0)
    force = np.array([[0.0], [1e-4 * CONSISTENT]])
    load = np.array([[2.0], [0.0]])
    for terms, forbids in ((1.0, False), (0.0, True)):
        motion[1, 0] = CONSISTENT / 10
        data = DataRates(load, motion, np.array([terms]), lambda y: force)
        found = Equations(Touching(np.eye(2), generators, np.eye(1, 4), *rows)).rates(data)
        assert bool(found.contradicts or found.opens.any()) == forbids
        assert_within(found.exerted[:, 0], [-2.0, 0.0], CONSISTENT)
