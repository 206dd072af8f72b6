"""How far derivatives hold: closed forms, verdicts next to kinks, the rows that touch there."""

import numpy as np
import pytest

from quasistatic_ref import PointCloud, derivatives, smoothed
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.optional.derivatives.step.touching import BEARING, touching_rows
from quasistatic_ref.solve.units import natural_units
from quasistatic_ref.step.cones import cone
from quasistatic_ref.tolerances import NEARLY
from tests.closeness import assert_relative
from tests.lab.vectors.committed_cases import cases
from tests.optional.derivatives.free_bodies import (
    BOX,
    FLOOR,
    NONE,
    G,
    H,
    falling_ball,
    free,
    vector_scene,
    verdict,
)
from tests.tolerances import ROUNDING

W = 0.3 * G
X, _, Z = np.eye(6)[:3]


def test_a_point_that_sticks_slides_where_its_load_leaves_the_pyramid():
    # |f_1| + |f_2| <= f_n / 2 of f = (0.2, -0.1, -1) W, which it bears by -d1 and +d2 alone there.
    simulator, q = free(PointCloud(np.zeros((1, 3))), (0, 0, 0), FLOOR, mu=(0.5, 0.0))
    found, _ = verdict(simulator, q, W * np.array([0.2, -0.1, 0, 0, 0, 0]))
    for way, share in ((X, 0.2), (-X, 0.6), (Z, 0.4), (-Z, np.inf)):
        assert_relative(found.reach_along(tau=way).distance, share * W, ROUNDING)
    by_x, _, by_z = found.reaches["dq_dtau"][:3]
    assert_relative([by_x.distance, by_z.distance], [0.2 * W, 0.4 * W], ROUNDING)
    assert by_x.where == ", ".join(f"row {row} of c0/0" for row in ("+d1", "-d2", "+spin", "-spin"))
    units = natural_units(found.result.step)
    force = units.size / (H * units.coordinate[0])
    assert found.reach <= 0.2 * W / force


def test_a_block_on_four_corners_slides_only_when_all_of_its_load_does():
    # Pushed at the height of the floor, it does not tilt.
    simulator, q = free(BOX, (0, 0, 0.05), FLOOR, k=4, mu=(0.4, 0.01))
    found, _ = verdict(simulator, q, 0.1 * W * X)
    at_the_floor = X + np.array([0, 0, 0, 0, -0.05, 0])
    ahead = found.reach_along(tau=at_the_floor)
    assert_relative(ahead.distance, 0.3 * W, 1e-9)
    assert ahead.where.count("row ") == 4 * 5
    assert "-d1" not in ahead.where


@pytest.mark.parametrize("gap", [3e-14, -3e-14])
def test_a_ball_that_nearly_reaches_the_floor_has_derivatives_on_both_sides(gap):
    simulator, q = falling_ball(gap)
    found, kinds = verdict(simulator, q)
    assert BEARING < abs(gap) / (H**2 * G) < NEARLY
    assert kinds == {reason.NEARLY}
    assert "settled: nearly a kink at row +d1 of c0/0" in {why.sentence for why in found.reasons}
    assert np.isnan(found.dq_dq[:, 2]).all()
    for way, slope in ((Z, 1.0), (-Z, 0.0)):
        np.testing.assert_allclose(found.along(q=way)[2], slope * way[2], atol=ROUNDING)
        one = derivatives(simulator, q, NONE, towards={"q": way})
        np.testing.assert_allclose(one.dq_dq[2, 2], slope, atol=ROUNDING)
    # Places are rounded to 7e-18 m.
    ahead = found.reach_along(q=-np.sign(gap) * Z)
    assert_relative(ahead.distance, abs(gap), 1e-3)
    assert ahead.where.count("row ") == 6
    exact = derivatives(simulator, q, NONE, nearly=0.0)
    assert exact.differentiable
    np.testing.assert_allclose(exact.dq_dq[2, 2], float(gap > 0), atol=ROUNDING)
    assert exact.reach == found.reach < NEARLY


@pytest.mark.parametrize("gap", [-1e-15, -1e-17])
def test_a_ball_whose_load_is_rounding_meets_no_kink_as_it_rises(gap):
    simulator, q = falling_ball(gap)
    found, kinds = verdict(simulator, q)
    assert kinds == {reason.WEAK}
    assert found.result.solution.lam.any()
    # It touches no more, and there is no other contact.
    assert found.reach_along(q=Z).distance == np.inf
    assert found.reach_along(tau=Z).distance == np.inf


def test_at_a_kink_the_reach_is_zero_and_a_smoothed_step_has_none():
    simulator, q = falling_ball()
    found, _ = verdict(simulator, q)
    assert found.reach == found.reaches["dq_dq"][2].distance == 0
    assert found.reaches["dq_dq"][0].distance == np.inf
    soft = smoothed(simulator, q, NONE, 1e-6)
    assert soft.reach == soft.reach_along(q=Z).distance == np.inf
    tied, at = free(PointCloud([X[:3], -X[:3]]), (0, 0, 0), FLOOR)
    named = verdict(tied, at)[0].reaches["dq_dq"][0]
    assert named == (0.0, "tie of points: c0/0, c0/1")


def rows_that_touch(simulator, q, target, force):
    """The rows that touch in a step."""
    result = simulator.step(q, target, force)
    far = np.abs(np.stack([result.points.alpha, result.points.beta])).max(axis=(0, 2))
    found = touching_rows(result.solution, far)
    rows = np.concatenate([found.strict, found.idle])
    names = cone(result.step.cone).row_names
    return {f"row {names[i]} of {result.step.contacts.name[j]}" for j, i in rows}


ASIDE = 1e-3
"""How far the steps on both sides of a kink are from it, over its distance."""
PAIRS = [case.id.partition("/")[2] for case in cases("derivative") if "/pair/" in case.id]


@pytest.mark.parametrize("seed", range(3))
def test_r41_the_rows_that_are_named_change_where_a_random_force_has_grown_so_far(seed):
    """Of a block on its corners, and of a pair of the vectors: steps linear piece by piece."""
    rng = np.random.default_rng(seed)
    block = free(BOX, (0, 0, 0.05), FLOOR, k=4, mu=(0.4, 0.01))
    ahead = 0
    for simulator, q, target in ((*block, NONE), vector_scene(str(rng.choice(PAIRS)))):
        arms = np.resize([1.0, 1.0, 1.0, 0.05, 0.05, 0.05], simulator.system.n_v)
        force, way = 0.1 * arms * rng.normal(size=(2, len(arms)))
        here = derivatives(simulator, q, target, force)
        kink = here.reach_along(tau=way)
        if not (here.differentiable and np.isfinite(kink.distance)):
            continue
        ahead += 1
        before, beyond = (
            rows_that_touch(simulator, q, target, force + (1 + side) * kink.distance * way)
            for side in (-ASIDE, ASIDE)
        )
        assert before ^ beyond == set(kink.where.split(", "))
    assert ahead
