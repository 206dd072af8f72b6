"""``distances = "coal"``: coal's distances as they are, beside the closed forms."""

import copy
import itertools

import coal
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Box,
    Capsule,
    Cone,
    ContactError,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    InputError,
    PointCloud,
    Simulator,
    Sphere,
    System,
    convex_hull,
    load_scenario,
    load_trajectory,
    save_trajectory,
)
from quasistatic_ref.optional.curved.measured_by_coal import MeasuredByCoal
from tests.closeness import assert_same, assert_within
from tests.contact.still import pair, placed_shape, standing_links
from tests.made import bits
from tests.oracles.records import header_in
from tests.tolerances import CLOSED_FORM

SOLIDS = {
    "box": Box((0.05, 0.07, 0.03)),
    "sphere": Sphere(0.06),
    "capsule": Capsule(0.03, 0.05),
    "half-space": HalfSpace((1.0, -2.0, 3.0), 0.01),
}
REFUSED = {
    "cylinder": Cylinder(0.05, 0.05),
    "cone": Cone(0.05, 0.05),
    "ellipsoid": Ellipsoid((0.03, 0.04, 0.05)),
    "mesh": convex_hull(SOLIDS["box"].corners(np.eye(3)[0])[0]),
}
NO_BODIES = System([])


def simulator(*pairs, distances="coal"):
    return Simulator(NO_BODIES, pairs, h=0.01, distances=distances)


@pytest.mark.parametrize("cloud_first", [True, False])
@pytest.mark.parametrize("name", SOLIDS)
def test_contacts_at_all_points_of_a_cloud_are_those_of_the_closed_forms(name, cloud_first):
    rng = np.random.default_rng(1)
    cloud = placed_shape(PointCloud(rng.uniform(-0.1, 0.1, (60, 3))), 1)
    inside = False
    for _ in range(5):
        R = Rotation.random(rng=rng).as_matrix()
        solid = placed_shape(SOLIDS[name], R=R, t=rng.uniform(-0.1, 0.1, 3))
        one = pair(*((cloud, solid) if cloud_first else (solid, cloud)), k=60)
        turned = Rotation.random(rng=rng).as_matrix()
        links = standing_links((turned, rng.uniform(-0.1, 0.1, 3)))
        closed = simulator(one, distances="closed").closest_points(links)
        inside |= closed.phi.min() < 0 < closed.phi.max()
        by_coal = simulator(one).closest_points(links)
        assert_same(by_coal.point, closed.point)
        assert_same(by_coal.tie, closed.tie)
        for field in ("phi", "alpha", "beta", "n"):
            assert_within(getattr(by_coal, field), getattr(closed, field), CLOSED_FORM)
    assert inside


ROUND = {name: SOLIDS[name] for name in ("sphere", "capsule", "half-space")}
ROUND_PAIRS = [*itertools.product(ROUND, ROUND)][:-1]


@pytest.mark.parametrize("kinds", ROUND_PAIRS, ids="-".join)
def test_round_solids_have_the_distances_of_the_closed_forms(kinds):
    """Apart, touching and in penetration; turned in any way, or with parallel axes."""
    rng = np.random.default_rng(2)
    solids = [ROUND[kind] for kind in kinds]
    inside = 0
    for i in range(40):
        turns = [Rotation.random(rng=rng).as_matrix() for _ in kinds]
        if i % 4 == 0:
            turns[1] = turns[0]
        places = rng.uniform(-0.1, 0.1, (2, 3))
        sides = [
            placed_shape(solid, link, R, t)
            for link, (solid, R, t) in enumerate(zip(solids, turns, places, strict=True))
        ]
        links = standing_links((np.eye(3), np.zeros(3)))
        closed = simulator(pair(*sides), distances="closed").closest_points(links)
        by_coal = simulator(pair(*sides)).closest_points(links)
        inside += closed.phi[0] < 0
        for field in ("phi", "alpha", "beta", "n"):
            assert_within(getattr(by_coal, field), getattr(closed, field), 10 * CLOSED_FORM)
    assert 0 < inside < 40


CAPSULE = SOLIDS["capsule"]
ACROSS = Rotation.from_euler("x", np.pi / 2).as_matrix()
NEARLY = Rotation.from_rotvec([-0.9e-7, -0.5e-7, 0.0]).as_matrix()


@pytest.mark.parametrize(
    ("sides", "k", "words"),
    [
        ([(CAPSULE, np.eye(3), 0.0), (CAPSULE, ACROSS, 0.0)], 1, "p: their axes meet, where coal"),
        ([(Sphere(0.1), np.eye(3), 0.0), (Sphere(0.2), np.eye(3), 0.0)], 1, "p: their axes meet"),
        ([(CAPSULE, np.eye(3), 0.0), (Sphere(0.1), np.eye(3), 0.0)], 1, "p: their axes meet"),
        ([(CAPSULE, np.eye(3), 0.0), (CAPSULE, NEARLY, 0.1)], 1, "p: coal's distance is off by"),
        ([(CAPSULE, np.eye(3), 0.0), (CAPSULE, ACROSS, 0.1)], 2, "and p is of capsule .* k = 2"),
        ([(SOLIDS["half-space"], np.eye(3), 0.0), (CAPSULE, ACROSS, 0.1)], 2, "capsule with k = 2"),
        ([(SOLIDS["box"], np.eye(3), 0.0), (Sphere(0.1), ACROSS, 0.4)], 1, "box and sphere: use"),
    ],
)
def test_where_coal_is_off_two_solids_are_refused(sides, k, words):
    placed = [
        placed_shape(solid, link, R, [x, 0.0, 0.0]) for link, (solid, R, x) in enumerate(sides)
    ]
    with pytest.raises(ContactError, match=words):
        simulator(pair(*placed, k)).closest_points(standing_links((np.eye(3), np.zeros(3))))


def test_distances_of_a_run_are_what_coal_says(monkeypatch):
    honest = coal.distance
    monkeypatch.setattr(coal, "distance", lambda *arguments: honest(*arguments) + 1e-6)
    closed = load_scenario("bunny_grasp", steps=1).run(findings=False)
    by_coal = load_scenario("bunny_grasp", steps=1, distances="coal").run(findings=False)
    assert_within(by_coal["phi"], closed["phi"] + 1e-6, CLOSED_FORM)


@pytest.mark.parametrize("mu_omega", [None, 0.0])
@pytest.mark.parametrize("steps", [30, pytest.param(600, marks=pytest.mark.long)])
def test_the_paper_s_grasp_has_equal_bits_with_either(steps, mu_omega):
    change = {} if mu_omega is None else {"contacts.grip.mu_omega": mu_omega}
    closed, by_coal = (
        load_scenario("bunny_grasp", change, steps=steps, distances=distances).run(findings=False)
        for distances in ("closed", "coal")
    )
    assert by_coal.steps == steps
    for field in ("q", "phi", "n", "alpha", "beta", "lam"):
        assert bits(by_coal[field]) == bits(closed[field]), field


def test_copies_of_a_simulator_keep_their_distances():
    by_coal = load_scenario("bunny_grasp", distances="coal").simulator()
    assert copy.copy(by_coal).distances == copy.deepcopy(by_coal).distances == "coal"


def test_a_trajectory_says_where_its_distances_come_from(tmp_path):
    runs = {
        distances: load_scenario("bunny_grasp", steps=1, distances=distances).run(findings=False)
        for distances in ("closed", "coal")
    }
    for distances, run in runs.items():
        path = save_trajectory(tmp_path / f"{distances}.npz", run)
        assert load_trajectory(path).header.distances == distances
        assert ("distances" in header_in(path)) == (distances == "coal")


@pytest.mark.parametrize("name", REFUSED)
def test_solids_that_coal_s_general_search_answers_for_are_refused_and_off(name):
    solid = REFUSED[name]
    cloud = placed_shape(PointCloud(np.zeros((1, 3))), 1)
    with pytest.raises(ContactError, match=r"distances: .*, and p is of pointcloud and \w+: use"):
        simulator(pair(cloud, placed_shape(solid)))


def test_two_solids_are_refused_by_the_pair_s_name():
    message = r"distances: coal's .* and rest\(floor, block/block#0\) is of halfspace and box"
    with pytest.raises(ContactError, match=message):
        load_scenario("arm_push", distances="coal")


def test_coal_is_off_inside_a_cylinder():
    """If this fails, coal has become right there, and cylinders need no longer be refused."""
    request = coal.DistanceRequest()
    request.enable_signed_distance = True
    at = coal.Transform3s(np.eye(3), np.array([0.02, 0.0, 0.03]))
    can = coal.Cylinder(0.05, 0.1), coal.Transform3s(np.eye(3), np.zeros(3))
    off = coal.distance(*can, coal.Sphere(0.0), at, request, coal.DistanceResult()) + 0.02
    assert abs(off) > 1e-3


def test_unknown_words_are_refused():
    with pytest.raises(InputError, match=r"distances: is not a choice; did you mean 'coal'\?"):
        simulator(distances="cole")


def test_an_answer_without_a_unit_normal_is_refused(monkeypatch):
    honest = coal.distance

    def spoilt(*arguments):
        phi = honest(*arguments)
        arguments[-1].normal = np.zeros(3)
        return phi

    monkeypatch.setattr(coal, "distance", spoilt)
    with pytest.raises(ContactError, match="box: coal has no normal for one of its points; use"):
        MeasuredByCoal(SOLIDS["box"]).signed_distance(np.zeros((1, 3)))
