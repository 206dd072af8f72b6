"""Constructed kinks of the program: weak rows, rows that contradict, no friction, half a turn."""

from collections.abc import Callable
from typing import Final

import numpy as np

from quasistatic_ref.contact.shape_in_world import ShapeInWorld
from quasistatic_ref.lab.scenes.pushes import SHAPES
from quasistatic_ref.lab.scenes.systems import link_text, robot_text
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.derivatives.step import reason
from quasistatic_ref.shapes.placed_shape import HalfSpace, PointCloud, Shape, Sphere
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array
from tests.oracles.gradients.placing import (
    FLOOR,
    MASS,
    POINT,
    UP,
    WEIGHT,
    G,
    H,
    Kink,
    Rng,
    Scene,
    any_turn,
    anywhere,
    spot,
)

WHEEL: Final = robot_text(
    link_text("rail", 1.0, (0.01, 0.01, 0.01)),
    link_text("wheel", 1.0, (0.01, 0.01, 0.01)),
    '<joint name="turn" type="continuous"><parent link="rail"/><child link="wheel"/>'
    '<axis xyz="0 0 1"/></joint>',
)
NO_FORCE: Final = np.zeros(6)


def lowest(shape: Shape, R: Array) -> float:
    """How far below its origin a body with a rotation R reaches [m]."""
    if isinstance(shape, PointCloud):
        return float(-(shape.points @ R.T)[:, 2].min())
    return float(-ShapeInWorld(shape, R, np.zeros(3)).farthest(-UP)[2])


def landing(rng: Rng) -> Kink:
    """A body that falls by h^2 g and just reaches the floor."""
    name = str(rng.choice(list(SHAPES)))
    R = any_turn(rng)
    height = lowest(SHAPES[name], R) + H**2 * G
    cone = str(rng.choice(["pyramid", "product", "facets-6", "frictionless"]))
    scene = Scene(
        SHAPES[name], R, spot(rng) + height * UP, [(FLOOR, np.eye(3), np.zeros(3))],
        cone=cone, force=NO_FORCE,
    )  # fmt: skip
    return Kink(reason.WEAK, f"a {name} that just lands", *anywhere(rng, scene))


def landing_aslant(rng: Rng) -> Kink:
    """A ball that is pushed along as it falls: one row of the cone is reached, the others not."""
    push = rng.uniform(1, 4, 2) * rng.choice([-1, 1], 2) * [1.0, 0.3]
    x = H**2 * push / MASS
    mu = rng.uniform(0.2, 0.6)
    # Where the scene is not turned, d1 and d2 are the world's axes x and y, up to their signs.
    height = 0.05 + H**2 * G + mu * np.abs(x).max()
    scene = Scene(
        Sphere(0.05), any_turn(rng), spot(rng) + height * UP, [(FLOOR, np.eye(3), np.zeros(3))],
        mu=(mu, 0.01), force=np.array([*push, 0, 0, 0, 0]),
    )  # fmt: skip
    return Kink(reason.WEAK, "a ball that lands aslant", *anywhere(rng, scene, turn=False))


def at_the_limit(rng: Rng) -> Kink:
    """A point that is pushed along the floor with all the friction that there is."""
    mu, more = rng.uniform(0.2, 0.9), rng.uniform(0, 3)
    share = float(rng.choice([0.0, 1.0, rng.uniform(0.2, 0.8)]))
    along = mu * (WEIGHT + more) * np.array([share, 1 - share]) * rng.choice([-1, 1], 2)
    scene = Scene(
        POINT, any_turn(rng), spot(rng), [(FLOOR, np.eye(3), np.zeros(3))],
        mu=(mu, 0.01), force=np.array([*along, -more, 0, 0, 0]),
    )  # fmt: skip
    return Kink(reason.WEAK, "a point at the limit of friction", *anywhere(rng, scene, turn=False))


def spin_at_the_limit(rng: Rng) -> Kink:
    """A ball that is twisted with mu_omega times what presses it."""
    mu, more = rng.uniform(0.005, 0.03), rng.uniform(0, 3)
    twist = mu * (WEIGHT + more) * float(rng.choice([-1, 1]))
    scene = Scene(
        Sphere(0.05), any_turn(rng), spot(rng) + 0.05 * UP, [(FLOOR, np.eye(3), np.zeros(3))],
        mu=(0.5, mu), force=np.array([0, 0, -more, 0, 0, twist]),
    )  # fmt: skip
    return Kink(reason.WEAK, "a ball at the limit of torsion", *anywhere(rng, scene))


def beside_a_wall(rng: Rng) -> Kink:
    """A ball that rests on the floor and just touches a wall."""
    wall = HalfSpace(np.array([-1.0, 0.0, 0.0]), -0.05)
    along = np.array([0.0, 0.0, -rng.uniform(0, 2), 0, 0, 0])
    fixed = [(FLOOR, np.eye(3), np.zeros(3)), (wall, np.eye(3), np.zeros(3))]
    scene = Scene(Sphere(0.05), any_turn(rng), 0.05 * UP, fixed, force=along)
    where = frozenset({"c1"})
    return Kink(reason.WEAK, "a ball beside a wall", *anywhere(rng, scene), where=where)


def ladder(rng: Rng) -> Kink:
    """A ladder that sticks at wall and floor."""
    foot, top = rng.uniform(0.2, 0.4), rng.uniform(0.3, 0.5)
    ends = PointCloud(np.array([[0.0, 0.0, 0.0], [-foot, 0.0, top]]))
    wall = HalfSpace(np.array([1.0, 0.0, 0.0]), 0.0)
    fixed = [(FLOOR, np.eye(3), np.zeros(3)), (wall, np.eye(3), np.zeros(3))]
    force = np.array([0.0, 0, -rng.uniform(20, 40), 0, -rng.uniform(1.5, 2.5), 0])
    scene = Scene(ends, np.eye(3), np.array([foot, 0, 0]), fixed, mu=(0.9, 0.01), force=force)
    where = frozenset({"c0", "c1"})
    return Kink(reason.CONTRADICTION, "a ladder", *anywhere(rng, scene), where=where)


def on_three_balls(rng: Rng) -> Kink:
    """A bar whose points in a row lie on three balls: a shift makes their rows contradict."""
    size = rng.uniform(0.1, 0.3)
    bar = PointCloud(size * np.array([[-1.0, 0, 0], [0, 0, 0], [1.0, 0, 0]]))
    radii = rng.uniform(0.05, 0.09, 3)
    fixed = [
        (Sphere(r), np.eye(3), np.array([x, 0, -r]))
        for r, x in zip(radii, bar.points[:, 0].tolist(), strict=True)
    ]
    scene = Scene(
        bar, np.eye(3), np.zeros(3), fixed, mu=(0.3, 0.01), rows=4, cone="frictionless",
        force=np.array([rng.uniform(-2, 2), 0, -rng.uniform(1, 5), 0, 0, 0]),
    )  # fmt: skip
    where, what = frozenset({"c0", "c1", "c2"}), "a bar on three balls"
    return Kink(reason.CONTRADICTION, what, *anywhere(rng, scene), where=where)


def no_friction(rng: Rng) -> Kink:
    """A body that is pressed on the floor without friction, or without torsion."""
    name = str(rng.choice(list(SHAPES)))
    R = any_turn(rng)
    mu = [(0.0, 0.01), (0.5, 0.0), (0.0, 0.0)][int(rng.integers(3))]
    scene = Scene(
        SHAPES[name], R, spot(rng) + (lowest(SHAPES[name], R) - 1e-4) * UP,
        [(FLOOR, np.eye(3), np.zeros(3))], mu=mu,
    )  # fmt: skip
    return Kink(reason.ZERO_FRICTION, f"a {name} without friction", *anywhere(rng, scene))


def half_a_turn(rng: Rng) -> Kink:
    """A driven joint or base whose target is half a turn away."""
    kind = str(rng.choice(["continuous", "floating", "planar"]))
    angle = rng.uniform(-3, 3)
    if kind == "continuous":
        system = System([Body("rail", WHEEL, actuated=("turn",))])
        q = np.array([np.cos(angle), np.sin(angle)])
        target = -q
    else:
        body = Body.of_shape("body", Sphere(0.05), MASS, base=kind, actuated=("base",))
        system = System([body])
        whole = np.zeros(6 if kind == "floating" else 3)
        q = system.integrate(system.q_start, rng.uniform(-0.5, 0.5, len(whole)))
        if kind == "floating":
            x, y, z = rng.normal(size=3)
            turn = np.array([x, y, z, 0.0]) / np.linalg.norm([x, y, z])
            a, w = q[3:6], q[6]
            target = np.concatenate(
                [q[:3] + 0.01, w * turn[:3] + np.cross(a, turn[:3]), [-(a @ turn[:3])]]
            )
        else:
            target = np.array([q[0] + 0.01, q[1], -q[2], -q[3]])
    simulator = Simulator(system, [], h=H, K_q=np.diag(rng.uniform(1, 5, system.n_a)))
    return Kink(
        reason.HALF_TURN, f"a {kind} joint half a turn from its target", simulator, q,
        np.zeros(system.n_v), target, where=frozenset({system.joints[0].name}),
    )  # fmt: skip


ROWS: Final[tuple[Callable[[Rng], Kink], ...]] = (
    landing,
    landing_aslant,
    at_the_limit,
    spin_at_the_limit,
    beside_a_wall,
    ladder,
    on_three_balls,
    no_friction,
    half_a_turn,
)
