"""Bodies that lie flat on each other: forces and motions by hand, whatever is flush.

A body at rest carries its weight: the normal forces on its contacts add up to m g. A body that is
d deep is pushed out in one step: it moves by d, under a force of m g + m d / h^2.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.separations import BISECTOR, OF_CLOUD, SAYS
from quasistatic_ref.errors import ContactError
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.shapes.convex_mesh import convex_hull
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    PlacedShape,
    PointCloud,
    Sphere,
)
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.tolerances import CLOSED_FORM
from validation.make.aligned_poses import tries

H, G, MASS = 0.01, 9.81, 1.0
SIDE = 0.1
INSETS = ((0.0, 0.0), (0.0, 1e-6), (1e-6, 1e-6), (1e-9, 1e-3))
"""Insets and depths [m]; validation/make/aligned_poses.py has all sixteen."""
UP = np.array([0.0, 0.0, 1.0])
OVER = np.diag([1.0, -1.0, -1.0])
"""Half a turn about x."""


def cube(inset: float = 0.0, half: float = SIDE / 2) -> Box:
    return Box(np.array([half - inset, half - inset, SIDE / 2]))


def frustum(inset: float = 0.0, half: float = SIDE / 2):
    low, high = half - inset, half / 2
    corners = [(low, -SIDE / 2), (high, SIDE / 2)]
    return convex_hull([[x, y, z] for r, z in corners for x in (-r, r) for y in (-r, r)])


# Of each shape: made with its base smaller by an inset; its base is SIDE / 2 below its origin.
FLAT = {
    "box": cube,
    "hull": frustum,
    "cylinder": lambda inset=0.0: Cylinder(SIDE / 2 - inset, SIDE / 2),
    "cone": lambda inset=0.0: Cone(SIDE / 2 - inset, SIDE / 2),
    "cloud": lambda inset=0.0, half=SIDE / 2: PointCloud(cube(inset, half).corners(UP)[0]),
}
SQUARE, CIRCULAR = ("box", "hull", "cloud"), ("cylinder", "cone")
ROUND = {
    "sphere": Sphere(SIDE / 2),
    "capsule": Capsule(SIDE / 4, SIDE / 4),
    "ellipsoid": Ellipsoid(np.array([0.04, 0.03, SIDE / 2])),
}


def body(name, xyz):
    """One of 1 kg and the inertia of a cube, whatever shape it has."""
    return Body.of_shape(name, cube(), MASS, xyz=xyz)


def fixed(shape, xyz=(0.0, 0.0, 0.0), R=None, name="low"):
    return PlacedShape(name, 0, np.eye(3) if R is None else R, np.array(xyz), shape)


def simulator_of(system, touching, k, mu_v=0.0, world=None):
    pairs = [ContactPair(f"p{i}", a, b, mu_v, 0.0, 4, k) for i, (a, b) in enumerate(touching)]
    gravity = -G * (UP if world is None else world @ UP)
    none = np.zeros((0, 0))
    return Simulator(system, pairs, h=H, K_q=none, gravity=gravity.tolist(), backend="none")


def taken(system, touching, k, mu_v=0.0):
    return simulator_of(system, touching, k, mu_v).step(system.q_start, np.zeros(0))


def one_on_another(low, R, top, depth, k, xy=(0.0, 0.0)):
    """The step of a body on a fixed one, whose upper surface is at z = SIDE / 2."""
    system = System([body("top", (*xy, SIDE - depth))])
    own = PlacedShape("top", system.link("top/solid"), np.eye(3), np.zeros(3), top)
    return taken(system, [(fixed(low, R=R), own)], k)


def lifted(result, depth):
    """Whether a body has only gone up, by its depth, under the force by hand."""
    c, force = result.step.contacts, result.solution.wrench[:, 2]
    assert (np.abs(c.n @ UP - 1.0) <= CLOSED_FORM)[force > 0].all()
    np.testing.assert_allclose(force.sum(), MASS * (G + depth / H**2), rtol=CLOSED_FORM)
    np.testing.assert_allclose(result.solution.delta_q, depth * np.eye(6)[2], atol=1e-15)


@pytest.mark.parametrize("top", FLAT)
@pytest.mark.parametrize("low", [kind for kind in FLAT if kind != "cloud"])
def test_base_on_base_the_force_is_the_weight(low, top) -> None:
    R = OVER if low in ("hull", "cone") else np.eye(3)
    # The corners of a square base are on the rim of a circular one.
    fits = {"half": SIDE / np.sqrt(8)} if top in SQUARE and low in CIRCULAR else {}
    for k, (inset, depth) in zip((4, 8, 12, 4), INSETS, strict=True):
        if top != "cloud" or depth == 0.0:  # a cloud's points have their own faces
            shape = FLAT[top](inset + (1e-12 if fits else 0.0), **fits)
            lifted(one_on_another(FLAT[low](), R, shape, depth, k), depth)


@pytest.mark.parametrize("top", ROUND)
@pytest.mark.parametrize("low", [kind for kind in FLAT if kind != "cloud"])
def test_a_round_shape_on_a_base_and_a_base_on_a_round_shape(low, top) -> None:
    R = OVER if low in ("hull", "cone") else np.eye(3)
    for k in (1, 4):
        lifted(one_on_another(FLAT[low](), R, ROUND[top], 1e-6, k), 1e-6)
        lifted(one_on_another(ROUND[top], np.eye(3), FLAT[low](), 1e-6, k), 1e-6)


def standing_bodies(places):
    """Cubes at places, and every two of them; those fixed in the world come last."""
    system = System([body(f"b{i}", xyz) for i, xyz in enumerate(places)])
    own = [
        PlacedShape(f"b{i}", system.link(f"b{i}/solid"), np.eye(3), np.zeros(3), cube())
        for i in range(len(places))
    ]
    return system, own


def loads(result, sides, count):
    """Sum of the contact forces on each body [N], shape (count, 3).

    `sides` has for each pair the numbers of alpha's body, None if it is fixed, and beta's.
    """
    c, wrench = result.step.contacts, result.solution.wrench
    force = (wrench[:, :3, None] * np.stack([c.d1, c.d2, c.n], axis=1)).sum(axis=1)
    found = np.zeros((count, 3))
    for name, f in zip(c.name, force, strict=True):
        alpha, beta = sides[int(name[1 : name.index("/")])]
        found[beta] += f
        if alpha is not None:
            found[alpha] -= f
    return found


def at_rest(places, k, mu_v=0.0):
    """Cubes on a fixed slab: none moves, and each carries its weight."""
    system, own = standing_bodies(places)
    slab = fixed(Box(np.array([1.0, SIDE / 2, 0.05])), (0.0, 0.0, -0.05))
    sides = [
        (i, j)
        for j, b in enumerate(places)
        for i, a in [(None, (*b[:2], -SIDE / 2)), *enumerate(places[:j])]
        if np.abs(np.subtract(a, b)).max() <= SIDE * (1 + 1e-9)
    ]
    touching = [(slab if i is None else own[i], own[j]) for i, j in sides]
    result = taken(system, touching, k, mu_v)
    np.testing.assert_allclose(result.solution.delta_q, 0.0, atol=1e-15)
    weights = np.tile([0.0, 0.0, MASS * G], (len(places), 1))
    np.testing.assert_allclose(
        loads(result, sides, len(places)), weights, rtol=0, atol=100 * CLOSED_FORM
    )
    return result


@pytest.mark.parametrize("k", [4, 8])
@pytest.mark.parametrize("count", [2, 10])
def test_equal_cubes_on_each_other_carry_all_above(count, k) -> None:
    result = at_rest([(0.0, 0.0, SIDE * (i + 0.5)) for i in range(count)], k)
    of_floor = [name.startswith("p0/") for name in result.step.contacts.name]
    total = result.solution.wrench[of_floor, 2].sum()
    np.testing.assert_allclose(total, count * MASS * G, rtol=CLOSED_FORM)


@pytest.mark.parametrize("k", [4, 8, 12])
def test_three_cubes_with_offsets_stand_still(k) -> None:
    # 10 and 20 mm each: the centre of the upper two is (15, 30) mm off that of the lowest.
    at_rest([(0.01 * i, 0.02 * i, SIDE * (i + 0.5)) for i in range(3)], k)


TABLE, RAIL = Box(np.array([0.2, 0.2, 0.01])), Box(np.array([0.02, 0.2, 0.01]))
BOOK, PUCK = Box(np.array([0.1, 0.07, 0.01])), Cylinder(0.07, 0.01)
LOG, CAPSULE, SPIRE = Cylinder(0.03, 0.1), Capsule(0.03, 0.1), Cone(0.03, 0.1)
STRAIGHT, AN_EIGHTH = np.eye(3), Rotation.from_rotvec(np.pi / 4 * UP).as_matrix()
ALONG_X = Rotation.from_rotvec([0.0, np.pi / 2, 0.0]).as_matrix()
ON_EDGE = Rotation.from_rotvec([np.pi / 4, 0.0, 0.0]).as_matrix()
SLANT = np.arctan2(0.03, 0.2)
ON_SIDE = Rotation.from_rotvec([0.0, np.pi / 2 + SLANT, 0.0]).as_matrix()
RESTING = {
    # A fixed body whose top is at z = 0.01, another, how that is turned, its place, the least k.
    "a book over an edge": (TABLE, BOOK, STRAIGHT, (0.19, 0.0, 0.02), 4),
    "a turned box on its like": (TABLE, TABLE, AN_EIGHTH, (0.0, 0.0, 0.02), 8),
    "a hull over an edge": (TABLE, frustum(), STRAIGHT, (0.19, 0.02, 0.06), 4),
    "a puck over an edge": (TABLE, PUCK, STRAIGHT, (0.19, 0.0, 0.02), 4),
    "a cone over an edge": (TABLE, Cone(0.07, 0.01), STRAIGHT, (0.19, 0.0, 0.02), 4),
    "a puck on a puck": (PUCK, Cylinder(0.05, 0.01), STRAIGHT, (0.04, 0.0, 0.02), 4),
    "a box on a puck": (PUCK, cube(), STRAIGHT, (0.03, 0.04, 0.06), 4),
    "a capsule on a rail": (RAIL, CAPSULE, ALONG_X, (0.01, 0.0, 0.04), 2),
    "a capsule over an edge": (TABLE, CAPSULE, ALONG_X, (0.19, 0.0, 0.04), 2),
    "a log on a rail": (RAIL, LOG, ALONG_X, (0.01, 0.0, 0.04), 2),
    "a log on a puck": (PUCK, LOG, ALONG_X, (0.02, 0.01, 0.04), 2),
    "a box on its edge": (RAIL, cube(), ON_EDGE, (0.01, 0.0, 0.01 + SIDE / np.sqrt(2)), 2),
    "a cone on its side": (RAIL, SPIRE, ON_SIDE, (0.0, 0.0, 0.01 + 0.015 * np.cos(SLANT)), 2),
}


@pytest.mark.parametrize("name", RESTING)
def test_a_body_whose_centre_is_over_what_touches_rests(name) -> None:
    """Nothing moves, and the contacts carry the weight, whichever is alpha and for every k."""
    low, top, R, place, least = RESTING[name]
    system = System([body("top", place)])
    own = PlacedShape("top", system.link("top/solid"), R, np.zeros(3), top)
    for k in (least, least + 1, 12):
        for sides in ((fixed(low), own), (own, fixed(low))):
            result = taken(system, [sides], k, 0.5)
            np.testing.assert_allclose(result.solution.delta_q, 0.0, atol=1e-15)
            force = result.solution.wrench[:, 2].sum()
            np.testing.assert_allclose(force, MASS * G, rtol=CLOSED_FORM)


def test_a_brick_bond_and_a_flush_wall_stand() -> None:
    half, z = SIDE / 2, SIDE * np.array([0.5, 1.5, 2.5])
    at_rest([(x * half, 0.0, z[row]) for row in range(3) for x in range(row, 6 - row, 2)], 4)
    at_rest([(x * SIDE, 0.0, z[row]) for row in range(2) for x in range(2)], 4)


@pytest.mark.parametrize("k", [4, 8, 12])
def test_each_shape_of_a_flush_corner_bears_its_share_alone(k) -> None:
    # A floor and two walls push along one axis each: f_i = m (g_i + d / h^2), and the box goes
    # d out along all three.
    pull = np.array([1.5, 2.5, G])
    system = System([body("box", (0.0, 0.0, 0.0))])
    none = np.zeros((0, 0))
    for inset, depth in INSETS:
        own = PlacedShape("box", system.link("box/solid"), np.eye(3), np.zeros(3), cube(inset))
        # Each face of the corner is `depth` inside the box; the walls follow a box with an inset.
        corner = [
            fixed(cube(), (depth + shift - SIDE) * way, name=f"side{i}")
            for i, (way, shift) in enumerate(zip(np.eye(3), (inset, inset, 0.0), strict=True))
        ]
        pairs = [ContactPair(f"p{i}", side, own, 0.0, 0.0, 4, k) for i, side in enumerate(corner)]
        simulator = Simulator(system, pairs, h=H, K_q=none, gravity=-pull, backend="none")
        solution = simulator.step(system.q_start, np.zeros(0)).solution
        forces = solution.wrench[:, 2].reshape(3, k).sum(axis=1)
        np.testing.assert_allclose(forces, MASS * (pull + depth / H**2), rtol=CLOSED_FORM)
        np.testing.assert_allclose(solution.delta_q, [depth] * 3 + [0.0] * 3, atol=1e-15)


@pytest.mark.parametrize("low", ["box", "hull", "cylinder", "cone"])
def test_one_contact_bears_what_its_lever_leaves(low) -> None:
    # A contact that is r off the centre of a cube of inertia I = m s^2 / 6 turns it, too:
    # f (1/m + |r x n|^2 / I) = g + d / h^2.
    R = OVER if low in ("hull", "cone") else np.eye(3)
    for top in ("box", "cylinder"):
        for inset, depth in INSETS[::3]:
            result = one_on_another(FLAT[low](), R, FLAT[top](inset), depth, 1)
            lever = result.points.beta[0] - [0.0, 0.0, SIDE - depth]
            share = 1 / MASS + np.sum(np.cross(lever, UP) ** 2) / (MASS * SIDE**2 / 6)
            np.testing.assert_allclose(result.points.n, [UP], atol=CLOSED_FORM)
            force = (G + depth / H**2) / share
            np.testing.assert_allclose(result.solution.wrench[0, 2], force, rtol=CLOSED_FORM)


def test_equal_gaps_of_zero_have_the_normal_between_and_deeper_ones_none() -> None:
    across = one_on_another(cube(), np.eye(3), cube(), 0.0, 4, (SIDE, 0.0))
    np.testing.assert_allclose(across.points.n, [[np.sqrt(0.5), 0, np.sqrt(0.5)]] * 4, atol=1e-15)
    assert across.tied == dict.fromkeys(across.step.contacts.name, SAYS[BISECTOR])
    with pytest.raises(
        ContactError, match=r"p0: the bodies are as deep .* along \[1., 0., 0.\] as"
    ):
        one_on_another(cube(), np.eye(3), cube(), 1e-3, 4, (SIDE - 1e-3, 0.0))


def test_a_cloud_takes_the_face_along_which_it_is_farthest_out() -> None:
    # Side by side the cloud's face x = 0.05 is flush with the box's, and so are y and z.
    for way in np.eye(3):
        system = System([body("top", SIDE * way)])
        points = PointCloud(cube().corners(UP)[0])
        own = PlacedShape("top", system.link("top/solid"), np.eye(3), np.zeros(3), points)
        result = taken(system, [(fixed(cube()), own)], 8)
        near = result.points.phi < SIDE / 2
        assert near.sum() == 4
        np.testing.assert_allclose(result.points.n[near], [way] * 4, atol=CLOSED_FORM)
        names = [
            name for name, is_near in zip(result.step.contacts.name, near, strict=True) if is_near
        ]
        assert result.tied == dict.fromkeys(names, SAYS[OF_CLOUD])


def test_turned_moved_and_swapped_a_body_moves_the_same() -> None:
    rng = np.random.default_rng(3)
    for W in Rotation.create_group("O").as_matrix().round()[::5]:
        shift = rng.integers(-2, 3, 3) / 4 + rng.choice([0.0, 1e-16], 3)
        system = System([body("top", W @ [0.03, 0.0, SIDE] + shift)])
        own = PlacedShape("top", system.link("top/solid"), W, np.zeros(3), cube())
        low = fixed(cube(), shift, W)
        for sides in ((low, own), (own, low)):
            result = simulator_of(system, [sides], 4, 0.3, W).step(system.q_start, np.zeros(0))
            np.testing.assert_allclose(result.solution.delta_q, 0.0, atol=1e-15)
            force = result.solution.wrench[:, 2].sum()
            np.testing.assert_allclose(force, MASS * G, rtol=CLOSED_FORM)


def test_a_sample_of_the_aligned_poses() -> None:
    tried, wrong = tries(range(63))
    assert wrong == []
    assert len(tried) == 5
