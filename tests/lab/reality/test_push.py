"""A push in steps: Lynch's motion, and what must not matter."""

from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import InputError, solve_step
from quasistatic_ref.lab.made_steps.slider import sliding_motion, sticking_motion
from quasistatic_ref.lab.reality.measurements import Pair
from quasistatic_ref.lab.reality.outline import Outline
from quasistatic_ref.lab.reality.predict import finger_waypoints, prediction
from quasistatic_ref.lab.reality.push import FINGER, pushed_scene
from quasistatic_ref.lab.reality.settings import Settings
from tests.tolerances import QUASI_STATIC

RATIO = 0.03
SQUARE = Outline(0.04 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]))
PAIR = Pair("glass/square", SQUARE, 0.5, 0.03)
START = np.array([0.2, 0.1, 0.0])
UP = np.array([0.0, 1.0])
BELOW = START[:2] + np.array([0.015, -0.04 - FINGER])
"""The finger touches the lower side, 15 mm off the middle."""
PATH = np.array([BELOW, BELOW + 0.02 * UP])


@pytest.mark.parametrize("mu_finger", [0.9, 0.0])
def test_a_slow_step_moves_a_slider_as_lynch_says(mu_finger):
    pair = replace(PAIR, mu_finger=mu_finger)
    scene = pushed_scene(Settings(h=20.0, advance=1e-4), pair, RATIO)
    body = np.append(START[:2], [0.0, 0.0])
    found = solve_step(scene.step(BELOW, body, BELOW + 1e-4 * UP))
    point = np.array([0.015, -0.04])
    way = found.delta_q[:2]
    chi2 = RATIO**2
    if mu_finger == 0.0:
        law = sliding_motion(point, UP, chi2) * way[1]
    else:
        law = sticking_motion(point, way, chi2)
    off = np.linalg.norm((found.delta_q[[2, 3, 5]] - law) * [1, 1, RATIO]) / way[1]
    assert off < QUASI_STATIC * scene.by.quasi_dynamic_number
    assert found.certificate.kind == "enclosure"


def test_steps_are_refused_whose_drag_is_not_small():
    with pytest.raises(InputError, match="quasi-dynamic"):
        pushed_scene(Settings(h=0.01), PAIR, RATIO)


def predicted(path=PATH, certify="full", **settings):
    return prediction(pushed_scene(Settings(**settings), PAIR, RATIO), START, path, certify)


def test_a_finger_that_passes_by_moves_nothing():
    # 55 mm below the side that is nearest
    found = predicted(np.array([[0.0, 0.0], [0.4, 0.0]]))
    assert (found.pose == START).all()
    assert found.kinds == {}


def test_steps_begin_where_the_finger_first_touches():
    scene = pushed_scene(Settings(), PAIR, RATIO)
    ahead = np.array([BELOW - 0.03 * UP, BELOW + 0.01 * UP])
    first, *targets = finger_waypoints(scene, START, ahead)
    assert first == pytest.approx(BELOW, abs=2e-6)
    assert len(targets) == 10 + (first[1] < BELOW[1])  # 10 mm, and what is left of the gap
    assert (targets[-1] == ahead[1]).all()


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-8"])
def test_steps_in_polyhedral_cones_are_exact(cone):
    found = predicted(cone=cone)
    assert set(found.kinds) == {"exact"}
    assert found.error_bound == 0.0


def test_a_push_whose_steps_have_no_bound_has_none():
    assert predicted(certify="off").error_bound is None
