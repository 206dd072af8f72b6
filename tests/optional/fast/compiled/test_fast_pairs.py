"""Contacts in compiled code against the brute force: the same bits, whatever happens."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from quasistatic_ref import (
    Box,
    Capsule,
    Cone,
    ContactError,
    ContactPair,
    Cylinder,
    Ellipsoid,
    HalfSpace,
    PointCloud,
    Sphere,
    convex_hull,
)
from quasistatic_ref.contact.distance import closest_points, pair_closest_points
from quasistatic_ref.contact.separations import OF_CLOUD
from quasistatic_ref.optional.fast.compiled import pairs as in_c
from quasistatic_ref.tolerances import TIED_FACES
from tests.contact.still import pair, placed_shape, standing_links
from tests.oracles.posed_pairs import PosedPairs

pytestmark = pytest.mark.extra("fast")
WEDGE = np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2], [0.2, 0.2, 0.1]])
SHAPES = {
    "sphere": Sphere(0.1),
    "box": Box((0.05, 0.125, 0.25)),
    "capsule": Capsule(0.05, 0.1),
    "cylinder": Cylinder(0.1, 0.05),
    "cone": Cone(0.1, 0.1),
    "ellipsoid": Ellipsoid((0.05, 0.1, 0.2)),
    "half-space": HalfSpace((0.0, 0.0, 1.0), -0.0625),
    "tilted half-space": HalfSpace((1.0, 2.0, 2.0), 0.1),
    "hull": convex_hull(WEDGE),
}


def cloud(kind, N, rng):
    """Points of which many are equally near to something: a grid, one point N times, a shell."""
    match kind:
        case "grid":  # exact in binary, so that ties are exact
            side = int(np.ceil(N ** (1 / 3)))
            return (np.stack(np.unravel_index(np.arange(N), (side,) * 3), axis=1) - side / 2) / 64
        case "copies":
            return np.repeat(rng.normal(size=(max(1, N // 8), 3)) / 16, 8, axis=0)[:N]
        case "shell":
            points = rng.normal(size=(N, 3))
            return 0.1 * points / np.linalg.norm(points, axis=1, keepdims=True)
        case "one place":
            return np.tile([[0.03, 0.0, -0.03]], (N, 1))
        case _:
            return rng.uniform(-0.1, 0.1, size=(N, 3))


CLOUDS = ["grid", "copies", "shell", "one place", "random"]
MOVES = ["stay", "creep", "slide", "turn", "come and go", "run", "jump", "inside"]


def next_pose(R, t, move, rng):
    """The next pose of a body."""
    small = {"creep": 1e-5, "turn": 1e-3, "run": 1e-2}.get(move, 0.0)
    turn = Rotation.from_rotvec(small * rng.normal(size=3)).as_matrix()
    match move:
        case "stay":
            return R, t
        case "slide":
            return R, t + np.array([rng.choice([1e-3, 8e-3]), 0.0, 0.0])
        case "come and go":
            return R, t + np.array([0.0, 0.0, rng.choice([-2e-3, 2e-3])])
        case "jump":
            return Rotation.random(rng=rng).as_matrix(), rng.uniform(-0.5, 0.5, size=3)
        case "inside":
            return R, rng.uniform(-0.01, 0.01, size=3)
        case _:
            return R @ turn, t + small * rng.normal(size=3)


def scene(names, kinds, rng, N, k):
    """One cloud on each solid; the solids on links 1.., the clouds on the links after them."""
    pairs = []
    for i, (name, kind) in enumerate(zip(names, kinds, strict=True)):
        R = Rotation.random(rng=rng).as_matrix() if i % 2 else np.eye(3)
        solid = placed_shape(SHAPES[name], 1 + i, R, rng.uniform(-0.1, 0.1, size=3) * (i % 2), name)
        some = placed_shape(PointCloud(cloud(kind, N, rng)), 1 + len(names) + i, name=kind)
        sides = (solid, some) if i % 3 else (some, solid)
        pairs.append(ContactPair(f"p{i}", *sides, 0.5, 0.0, 4, k))
    return pairs


def bits(values):
    return np.ascontiguousarray(values).view(np.int64)


def is_new(tracker):
    """Whether the only list was made at the last poses."""
    (each,) = tracker.pairs.clouds
    return each.number("age") == 0


def same_bits(tracker, pairs, R, t):
    expected = closest_points(pairs, standing_links(*zip(R[1:], t[1:], strict=True)))
    found = tracker.closest_points(R, t)
    for field, own in found._asdict().items():
        np.testing.assert_array_equal(bits(own), bits(getattr(expected, field)), err_msg=field)
    return found


@settings(max_examples=25)
@given(
    names=st.lists(st.sampled_from(sorted(SHAPES)), min_size=1, max_size=4),
    kinds=st.lists(st.sampled_from(CLOUDS), min_size=4, max_size=4),
    moves=st.lists(st.sampled_from(MOVES), min_size=1, max_size=10),
    N=st.sampled_from([1, 3, 30, 100, 500]),
    k=st.sampled_from([1, 5, 12]),
    width=st.sampled_from([1, 16, 32]),
    seed=st.integers(0, 1000),
)
def test_followed_contacts_are_those_of_brute_force(names, kinds, moves, N, k, width, seed):
    rng = np.random.default_rng(seed)
    pairs = scene(names, kinds[: len(names)], rng, N, k)
    L = 1 + 2 * len(names)
    tracker = PosedPairs(pairs, L)
    for each in tracker.pairs.clouds:
        each.put({"width": width})
    R = np.tile(np.eye(3), (L, 1, 1))
    t = np.zeros((L, 3))
    t[1 + len(names) :] = rng.uniform(-0.3, 0.3, size=(len(names), 3))
    for move in moves:
        for link in range(1, L):
            R[link], t[link] = next_pose(R[link], t[link], move, rng)
        same_bits(tracker, pairs, R, t)


def poses(*t):
    """Links 1.. at places t, none turned."""
    t = np.array([(0.0, 0.0, 0.0), *t])
    return np.tile(np.eye(3), (len(t), 1, 1)), t


def sheet(side, spacing):
    """A flat square of points about the origin, all equally high."""
    x, y = np.meshgrid(np.arange(side) - side // 2, np.arange(side) - side // 2)
    return spacing * np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)


def one_pair(shape, points, k):
    return [pair(placed_shape(shape, 1), placed_shape(PointCloud(points), 2), k)]


@pytest.mark.parametrize("name", ["sphere", "cylinder"])
def test_points_from_the_side_are_seen_once_they_are_nearer(name, rng):
    points = rng.uniform(-0.01, 0.01, size=(300, 3))
    above = in_c.WIDTH  # so that the first list is these, and the others are far
    points[:above, 2] += 0.4
    points[above:, 0] -= 0.6
    pairs = one_pair(SHAPES[name], points, 5)
    tracker = PosedPairs(pairs, 3)
    seen = []
    made = 0
    for x in np.linspace(0, 0.5, 26):
        R, t = poses((0, 0, 0), (x, 0, 0))
        same_bits(tracker, pairs, R, t)
        made += is_new(tracker)
        seen.append(tracker.found.point.min() >= above)
    assert not seen[0]
    assert seen[-1]
    assert made < 26


FLOOR = HalfSpace((0.0, 0.0, 1.0), 0.0)


@pytest.mark.parametrize(("solid", "top", "away"), [(FLOOR, 0.0, 1.0), (SHAPES["box"], 0.25, 0.0)])
def test_a_sheet_that_comes_and_goes_needs_no_new_list(solid, top, away, rng):
    """Its first point is far beyond the sides of the box, with another normal."""
    points = sheet(40, 1 / 512)
    points[:, 2] = rng.uniform(0, 0.01, size=len(points))
    points[0] = [-1.0, 0.0, 0.01]
    pairs = one_pair(solid, points, 5)
    tracker = PosedPairs(pairs, 3)
    made = 0
    for z in rng.uniform(0, 0.2, size=50):
        same_bits(tracker, pairs, *poses((0, 0, 0), (away * z, 0, top + z)))
        made += is_new(tracker)
    assert made == 1


@pytest.mark.parametrize("name", ["sphere", "box", "capsule", "cylinder"])
def test_the_far_end_of_a_stick_is_seen_once_it_has_turned_round(name, rng):
    """One end is in the first list. The stick turns about a vertical axis; the other comes near."""
    ends = np.repeat([[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]], in_c.WIDTH, axis=0)
    pairs = one_pair(SHAPES[name], ends + rng.uniform(-1e-3, 1e-3, size=ends.shape), 5)
    tracker = PosedPairs(pairs, 3)
    for angle in np.linspace(0, np.pi, 37):
        R, t = poses((0, 0, 0), (0.5, 0, 0))
        R[2] = Rotation.from_rotvec([0, 0, angle]).as_matrix()
        found = same_bits(tracker, pairs, R, t)
        assert (found.point.min() >= in_c.WIDTH) == (angle > np.pi / 2)


def test_points_that_are_as_high_but_for_rounding_are_all_looked_at(rng):
    """Points in the plane of a half-space have heights of rounding errors, which motion changes."""
    solid = HalfSpace((1.0, 2.0, 2.0), 1.0)
    along = np.array([[2.0, 1.0, -2.0], [-2.0, 2.0, -1.0], [1.0, 2.0, 2.0]]) / 3
    pairs = one_pair(solid, sheet(20, 1 / 512) @ along, 5)
    tracker = PosedPairs(pairs, 3)
    for slide in rng.uniform(-0.1, 0.1, size=(30, 2)):
        same_bits(tracker, pairs, *poses((0, 0, 0), slide @ along[:2] + along[2] / 3))


@pytest.mark.parametrize("cloud_first", [False, True])
def test_zero_is_positive(cloud_first):
    """Half a turn about z whose zeros are -0.0, and a height that is -0.0."""
    turned = -np.eye(3)
    turned[2, 2] = 1.0
    points = placed_shape(PointCloud([[1.0, 1.0, 0.0]]), 1)
    pairs = []
    for z in (1.0, -1.0):
        solid = placed_shape(HalfSpace((0.0, 0.0, z), 0.0), R=turned)
        pairs.append(pair(points, solid) if cloud_first else pair(solid, points))
    found = same_bits(PosedPairs(pairs, 2), pairs, *poses((0, 0, 0)))
    assert not bits(found.phi).any()
    assert not bits(found.n[:, :2]).any()


def test_points_that_touch_two_faces_at_once_are_left_to_the_plain_path(monkeypatch):
    """Points about two edges of a box, at multiples of half of what counts as equal."""
    asked = []

    def recorded(pair, *args):
        asked.append(pair.name)
        return pair_closest_points(pair, *args)

    monkeypatch.setattr(in_c, "pair_closest_points", recorded)
    far = np.array([4.0, 0.0, 0.0])  # of the cloud's frame: no place is larger
    half = TIED_FACES * far[0] / 2
    x, y, z = 0.25, 0.5, 1.0
    box = placed_shape(Box((x, y, z)), 1)
    pairs = []
    tied = []
    for i, j, side in itertools.product(range(-4, 4), range(-4, 4), (1, -1)):
        # The other point makes the whole cloud farthest out along y.
        points = side * np.array([(x + i * half, y + j * half, 0.0), (x / 2, 1.5 * y, 0.0)]) - far
        cloud = placed_shape(PointCloud(points), 2)
        pairs.append(ContactPair(f"{i} {j} {side}", box, cloud, 0.5, 0.0, 4, 1))
        phi = max(i, j) if max(i, j) <= 0 else np.hypot(max(i, 0), max(j, 0))
        if phi <= 2 and abs(i - j) <= 2:
            tied.append(pairs[-1].name)
    found = same_bits(PosedPairs(pairs, 3), pairs, *poses((0, 0, 0), far))
    assert {*tied} <= {*asked}
    of_cloud = {pairs[i].name for i in np.flatnonzero(found.tie == OF_CLOUD)}
    assert {*asked} >= of_cloud
    asked.clear()
    pairs = [
        ContactPair("off", box, placed_shape(PointCloud([[x, 0.0, 0.0]] - far), 2), 0.5, 0.0, 4, 1)
    ]
    same_bits(PosedPairs(pairs, 3), pairs, *poses((0, 0, 0), far))
    assert not asked


def test_pairs_of_solids_and_of_clouds_stay_in_their_order(rng):
    solid = [placed_shape(SHAPES["box"], i) for i in (1, 2)]
    points = placed_shape(PointCloud(cloud("random", 99, rng)), 3)
    sphere = placed_shape(SHAPES["sphere"], 3)
    sides = [(solid[0], points), (solid[0], solid[1]), (points, solid[1]), (solid[1], sphere)]
    pairs = [pair(*two, 3) for two in sides]
    same_bits(PosedPairs(pairs, 4), pairs, *poses((0, 0, 0.4), (0, 0.3, 0), (0.1, 0, 0.1)))


@pytest.mark.parametrize("first", [True, False])
def test_a_pose_that_is_not_finite_is_refused(first, rng):
    pairs = one_pair(SHAPES["box"], cloud("random", 99, rng), 5)
    tracker = PosedPairs(pairs, 3)
    if not first:
        tracker.closest_points(*poses((0, 0, 0), (0, 0, 1)))
    with pytest.raises(ContactError, match="poses: must be finite"):
        tracker.closest_points(*poses((0, 0, 0), (0, 0, np.nan)))
