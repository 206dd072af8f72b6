"""The profile of a step: what is counted."""

import pytest

from quasistatic_ref.lab.bench.profile import grasp_scenario, tracked_distances

STEPS = 6


@pytest.mark.extra("fast")
def test_the_tracker_evaluates_all_points_for_a_first_list_and_later_the_list_alone():
    found = tracked_distances(grasp_scenario("clarabel", "off"), STEPS)
    # Three pairs: a list out of 992 points, 32 on it; the first step is compared, and found twice.
    assert found[0] == 3 * (992 + 2 * 32)
    assert (found[1:] == 3 * 32).all()
