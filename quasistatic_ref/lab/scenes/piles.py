"""Many free bodies: boxes in a row, or piled up, to show what large steps cost."""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.lab.scenes.systems import body_text, on_link, system_of, world_plane
from quasistatic_ref.optional.fast.simulator import FastSimulator
from quasistatic_ref.shapes.placed_shape import PlacedShape, PointCloud
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.data import Array

SIDE = 0.05
"""Side of a box [m]."""

GAP = 1e-4
"""Between neighbours at the start [m]."""

WITHIN = 0.9
"""Which part of a face has points. Where boxes of one size stand aligned, a point on an edge lies
on two side faces of its neighbour, and such points ask for opposite motions: no step satisfies
them."""

H, MU_V, MU_OMEGA = 0.001, 0.5, 0.01
"""Time step [s]; friction [-], [m]. A push F moves a lone body of mass m by h^2 F / m in a step:
with 480 N and h = 0.01 s by twice its side, and a corner 7 mm inside of its neighbour asks for
motions that contradict each other."""

PUSH = 3.0
"""Force on the first body for each there is [N]; friction with the floor holds 2.45 N of it."""

BOX = body_text(0.5, (2.1e-4,) * 3, f'<box size="{SIDE} {SIDE} {SIDE}"/>')


@dataclass(frozen=True, eq=False)
class Pile:
    """A simulator with something to do.

    Parameters
    ----------
    simulator : Simulator
    q : ndarray, shape (n_q,)
        Where it starts.
    force : ndarray, shape (n_v,)
        A push on the first body along x, more than the friction of all on the floor [N, N m].
    bodies, contacts : int
    """

    simulator: Simulator
    q: Array
    force: Array
    bodies: int
    contacts: int


def pile(
    shape: tuple[int, int, int],
    k: int = 4,
    *,
    backend: str | None = "clarabel",
    certify: str = "off",
    gap: float = GAP,
    yaw: float = 0.0,
) -> Pile:
    """Boxes in a grid of nx x ny x nz, each touching its neighbours and the lowest the floor.

    A row is a chain: body i touches body i + 1. Bodies are clouds to what is below and before
    them.

    Parameters
    ----------
    shape : (int, int, int)
    k : int
        Contacts of each pair.
    backend, certify : str
        As in :class:`~quasistatic_ref.simulate.simulator.Simulator`.
    gap : float
        Between neighbours side by side [m]; with a side or more they are no pairs.
    yaw : float
        Each box is turned about the vertical by up to so much, at random [rad].
    """
    index = np.arange(np.prod(shape)).reshape(shape)
    places = np.stack(np.unravel_index(index.ravel(), shape), axis=1)
    xyz = SIDE * places + [gap, gap, GAP] * places + [0.0, 0.0, SIDE / 2]
    names = [f"box{i}" for i in range(index.size)]
    turned = yaw * np.random.default_rng(0).uniform(-1, 1, index.size)
    starts = {
        name: {"xyz": tuple(at), "rpy": (0.0, 0.0, angle)}
        for name, at, angle in zip(names, xyz.tolist(), turned.tolist(), strict=True)
    }
    system = system_of(dict.fromkeys(names, BOX), **starts)
    cloud = PointCloud(_surface())
    floor = world_plane()
    boxes = {shape.link: shape for shape in system.shapes}
    clouds = [on_link(system, name, cloud) for name in names]
    pairs = [_pair(floor, clouds[i], k) for i in index[:, :, 0].ravel()]
    for axis in range(3) if gap < SIDE else [2]:
        before = np.delete(index, -1, axis=axis).ravel()
        after = np.delete(index, 0, axis=axis).ravel()
        pairs += [
            _pair(boxes[clouds[i].link], clouds[j], k) for i, j in zip(before, after, strict=True)
        ]
    simulator = Simulator(
        system, pairs, h=H, K_q=np.zeros((0, 0)), backend=backend, certify=certify
    )
    force = np.zeros(system.n_v)
    force[0] = PUSH * index.size  # along x
    contacts = sum(pair.n_c for pair in pairs)
    return Pile(FastSimulator(simulator), system.q_start, force, index.size, contacts)


def _pair(alpha: PlacedShape, beta: PlacedShape, k: int) -> ContactPair:
    return ContactPair(f"{alpha.name}-{beta.name}", alpha, beta, MU_V, MU_OMEGA, 6, k)


def _surface() -> Array:
    """Points on the six faces of a box, 5 x 5 each, the outermost of each face first."""
    line = WITHIN * np.linspace(-SIDE / 2, SIDE / 2, 5)
    u, v = (some.ravel() for some in np.meshgrid(line, line, indexing="ij"))
    faces = [
        np.insert(np.stack([u, v], axis=1), axis, side, axis=1)
        for axis in range(3)
        for side in (-SIDE / 2, SIDE / 2)
    ]
    points = np.concatenate(faces)
    out = np.isclose(np.abs(points), WITHIN * SIDE / 2).sum(axis=1)
    return np.asarray(points[np.argsort(-out, kind="stable")])
