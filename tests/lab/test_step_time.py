"""The profile of a step: what is counted and timed, and when the claim about it fails."""

from quasistatic_ref.lab.study.bench.profile import (
    grasp_scenario,
    tracked_distances,
)
from quasistatic_ref.optional.fast.tracker import cloud_pairs
from quasistatic_ref.shapes.half_space import HalfSpace
from quasistatic_ref.shapes.rounded import Rounded

STEPS = 6


def test_the_distances_of_the_tracker_are_those_that_it_really_evaluates(monkeypatch):
    counted = []
    for kind in (Rounded, HalfSpace):

        def distances(shape, points, own=kind.signed_distance):
            if len(points) > 5:  # not for the faces of those that are kept
                counted.append(len(points))
            return own(shape, points)

        monkeypatch.setattr(kind, "signed_distance", distances)

    def together(points, own=cloud_pairs.distance_to_rounded_box, **sizes):
        counted.append(len(points))
        return own(points, **sizes)

    monkeypatch.setattr(cloud_pairs, "distance_to_rounded_box", together)
    found = tracked_distances(grasp_scenario("clarabel", "off"), STEPS)
    assert found.sum() == sum(counted)
    # 3 first lists: a normal out of 992 points, a list out of 992, 32 on it. A later step
    # evaluates the lists alone.
    assert found[0] == 3 * (992 + 992 + 32)
    assert (found[1:] == 3 * 32).all()
