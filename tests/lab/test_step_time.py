"""The profile of a step: what is counted and timed, and when the claim about it fails."""

import pytest

from quasistatic_ref.lab.claims.claim import FAILS, HOLDS, finding
from quasistatic_ref.lab.claims.paper import step_time
from quasistatic_ref.lab.study.bench.profile import (
    BRUTE_FORCE,
    PARTS,
    TRACKER,
    Profile,
    Profiles,
    all_distances,
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


def test_brute_force_evaluates_every_point_against_every_object():
    assert all_distances(grasp_scenario("clarabel", "off")) == 3 * 992


def planted(solve, backend="x", distances=TRACKER):
    """A profile in which the solve has a certain share, half of it the solver's call."""
    rest = (1 - solve) / 3
    times = dict(zip(PARTS, (solve / 2, solve / 2, rest, rest, rest), strict=True))
    return Profile(backend, "off", distances, times, times | {PARTS[0]: 10.0})


SHARES = {
    ("clarabel", TRACKER): 1.0, ("clarabel", BRUTE_FORCE): 0.5,
    ("piqp", TRACKER): 0.5, ("piqp", BRUTE_FORCE): 0.3,
    ("osqp", TRACKER): 0.5, ("osqp", BRUTE_FORCE): 0.3,
    ("daqp", TRACKER): 0.3, ("daqp", BRUTE_FORCE): 0.1,
}  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({}, HOLDS),
        ({("clarabel", TRACKER): 0.45}, FAILS),
        ({("daqp", TRACKER): 0.55}, FAILS),
        ({"tracked": 298.0}, FAILS),
        ({"gap": 1e-16}, FAILS),
    ],
)
def test_the_claim_fails_where_a_share_or_a_count_is_another(monkeypatch, changes, verdict):
    numbers = {**SHARES, "tracked": 297.0, "gap": 0.0, **changes}
    taken = tuple(planted(numbers[key], *key) for key in SHARES)
    found = {"profiles": Profiles(taken, numbers["gap"]), "all": 2976, "h": 0.01}
    monkeypatch.setattr(step_time, "measured", lambda: found | {"tracked": numbers["tracked"]})
    assert finding(step_time.CLAIM).verdict == verdict
