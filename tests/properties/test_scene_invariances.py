"""What must not matter about a scene: where the world's origin is, and where a URDF puts a body's.

At the level of steps, see test_invariances.py; here the scene goes through URDF, System, closest
points and Jacobians.
"""

from itertools import permutations, product

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.scenes.contacts import repeated
from quasistatic_ref.lab.scenes.systems import link_text, robot_text, system_of
from quasistatic_ref.shapes.placed_shape import Box, HalfSpace, PlacedShape, PointCloud
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.solve import solve_step
from tests.helpers import random_frame
from tests.tolerances import EXACT, SCENE

GAP = 1e-4
H, GRAVITY = 0.01, np.array([0.3, -0.2, -9.81])
seeds = st.integers(0, 2**32 - 1)
QUARTER_TURNS = [
    R
    for order, signs in product(permutations(range(3)), product([1, -1], repeat=3))
    if np.linalg.det(R := np.diag(signs)[list(order)].astype(float)) > 0
]
"""The 24 rotations that take axes to axes."""


def rpy_of(R):
    """Roll, pitch, yaw of a rotation; pitch of a quarter turn included."""
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    if abs(abs(pitch) - np.pi / 2) < 1e-9:
        return 0.0, pitch, np.arctan2(-R[0, 1], R[1, 1])
    return np.arctan2(R[2, 1], R[2, 2]), pitch, np.arctan2(R[1, 0], R[0, 0])


def numbers(rng):
    """What a scene is made of: a slab and a cloud body on it, pressed and pulled."""
    R = random_frame(rng)
    return {
        "R": R,  # of the slab; the cloud body starts next to it, turned a little further
        "turn": random_frame(rng),
        "points": rng.uniform(-0.05, 0.05, (12, 3)),
        "mass": rng.uniform(0.2, 2.0, 2),
        "inertia": rng.uniform(1e-3, 1.5e-3, (2, 3)),
        "load": rng.normal(size=(2, 2, 3)) * [[[3.0], [0.1]]],
        "mu": rng.uniform(0.1, 1.0),
        "mu_omega": rng.uniform(0.005, 0.05),
    }


def answer(
    scene, world=None, shift=(0, 0, 0), origin=None, offset=(0, 0, 0), rough=True, swapped=False
):
    """World motion of both centres of mass in one step: (linear, angular) of slab and cloud.

    `world` and `shift` move everything; `origin` and `offset` say how the frame of the cloud's
    link lies in the frame that its points were given in.
    """
    W, F = np.eye(3) if world is None else world, np.eye(3) if origin is None else origin
    shift, offset = np.array(shift), np.array(offset)
    R_slab, R_cloud = W @ scene["R"], W @ scene["turn"] @ F
    at = W @ scene["turn"] @ offset
    # Both the slab and the ground are GAP from the nearest point: no penetration, yet contact.
    lowest = (scene["points"] @ scene["turn"].T @ scene["R"])[:, 2].min() - GAP
    floor = (scene["points"] @ scene["turn"].T)[:, 2].min() - GAP
    slab_at = W @ scene["R"] @ [0, 0, lowest - 0.02] + shift
    # A rotated inertia needs a rotated frame in the file; the moments are given along its axes.
    (m_slab, m_cloud), (I_slab, I_cloud) = scene["mass"], scene["inertia"]
    roll, pitch, yaw = rpy_of(F.T)
    body = link_text("cloud", float(m_cloud), I_cloud, com=F.T @ -offset).replace(
        "/><mass", f' rpy="{roll!r} {pitch!r} {yaw!r}"/><mass', 1
    )
    texts = {
        "slab": robot_text(link_text("slab", float(m_slab), I_slab)),
        "cloud": robot_text(body),
    }
    texts = {name: text.replace("np.float64(", "").replace(")", "") for name, text in texts.items()}
    system = system_of(
        texts,
        slab={"xyz": slab_at, "rpy": rpy_of(R_slab)},
        cloud={"xyz": at + shift, "rpy": rpy_of(R_cloud)},
    )
    identity, zero = np.eye(3), np.zeros(3)
    plate = PlacedShape(
        "plate", system.link("slab"), identity, zero, Box(np.array([0.2, 0.2, 0.02]))
    )
    points = (scene["points"] - offset) @ F
    cloud = PlacedShape("cloud", system.link("cloud"), identity, zero, PointCloud(points))
    up = W @ [0, 0, 1.0]
    ground = PlacedShape("ground", 0, identity, zero, HalfSpace(up, float(up @ shift) + floor))
    mu = scene["mu"] if rough else 0.0
    sides = (cloud, plate) if swapped else (plate, cloud)
    pairs = (
        ContactPair("touch", *sides, mu, scene["mu_omega"], 6, 4),
        ContactPair("ground", ground, cloud, mu, 0.0, 4, 2),
    )
    simulator = Simulator(
        system,
        pairs,
        h=H,
        K_q=np.zeros((0, 0)),
        gravity=(W @ GRAVITY).tolist(),
        backend="none",
        fast=True,
    )
    q = system.q_start
    force = sum(
        system.centre_of_mass_force(q, name, W @ load[0], W @ load[1])
        for name, load in zip(("slab", "cloud"), scene["load"], strict=True)
    )
    result = simulator.step(q, np.zeros(0), force)
    here, motions = system.kinematics(q), []
    centres = (np.zeros(3), F.T @ -offset)
    for name, centre in zip(("slab", "cloud"), centres, strict=True):
        link = system.link(name)
        linear, angular = np.split(here.J[link] @ result.solution.delta_q, 2)
        motions += [linear + np.cross(angular, here.R[link] @ centre), angular]
    return np.array(motions), result


def assert_same(actual, expected):
    scale = np.abs(expected).max()
    np.testing.assert_allclose(actual, expected, rtol=0.0, atol=SCENE * scale)


@given(seeds, st.integers(0, 23))
def test_a_quarter_turn_and_a_shift_of_the_world_leave_the_scene_as_it_is(seed, which):
    scene = numbers(np.random.default_rng(seed))
    W, shift = QUARTER_TURNS[which], np.random.default_rng(seed).uniform(-1, 1, 3)
    still, _ = answer(scene)
    moved, _ = answer(scene, W, shift)
    assert_same(moved, still @ W.T)


@given(seeds)
def test_without_tangential_friction_the_world_may_be_turned_by_any_angle(seed):
    # With it, the pyramid's axes stay behind: they are a function of n in the world.
    rng = np.random.default_rng(seed)
    scene, W = numbers(rng), random_frame(rng)
    still, _ = answer(scene, rough=False)
    moved, _ = answer(scene, W, rng.uniform(-1, 1, 3), rough=False)
    assert_same(moved, still @ W.T)


@given(seeds)
def test_where_the_urdf_puts_the_origin_of_a_body_does_not_matter(seed):
    rng = np.random.default_rng(seed)
    scene = numbers(rng)
    there, _ = answer(scene)
    elsewhere, _ = answer(scene, origin=random_frame(rng), offset=rng.uniform(-0.2, 0.2, 3))
    assert_same(elsewhere, there)


@given(seeds)
def test_which_of_two_bodies_is_alpha_does_not_matter(seed):
    scene = numbers(np.random.default_rng(seed))
    one, _ = answer(scene)
    two, _ = answer(scene, swapped=True)
    assert_same(two, one)


@given(seeds)
def test_contacts_given_twice_and_in_another_order_leave_the_same_bits(seed):
    rng = np.random.default_rng(seed)
    _, result = answer(numbers(rng))
    n_c = result.step.contacts.n_c
    again = [*rng.permutation(n_c), *rng.permutation(n_c)[:2]]
    twice = result.step.replace(contacts=repeated(result.step.contacts, again))
    delta_q = solve_step(twice, "none").delta_q
    np.testing.assert_allclose(delta_q, result.solution.delta_q, rtol=EXACT, atol=EXACT)
