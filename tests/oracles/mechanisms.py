"""Random mechanisms with mimic joints: their URDF, J, M and gravity, without the package.

The links are placed by complex numbers: the derivative of a pose by a coordinate is the imaginary
part that an imaginary step of 1e-30 leaves, without truncation. M is the sum of
m J_c' J_c + J_w' I J_w over the links.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

STEP = 1e-30
"""The imaginary step of a coordinate [m, rad]: its square is nothing next to 1."""
GRAVITY = (1.0, -2.0, -9.81)


@dataclass(frozen=True)
class Link:
    """A link, its inertia, and the joint that moves it; `leader` counts in the links."""

    name: str
    parent: int
    kind: str
    xyz: np.ndarray
    rpy: np.ndarray
    axis: np.ndarray
    mass: float
    com: np.ndarray
    com_rpy: np.ndarray
    moments: np.ndarray
    actuated: bool
    leader: int | None = None
    multiplier: float = 1.0
    offset: float = 0.0

    @property
    def joint(self) -> str:
        """Name of its joint."""
        return f"j{self.name}"


@dataclass(frozen=True)
class Mechanism:
    """Some links, the root first, and how the root moves."""

    name: str
    links: list[Link]
    base: str
    base_actuated: bool


def random_links(rng: np.random.Generator, count: int) -> list[Link]:
    """A random tree of links; about half of the joints that can follow another one do."""
    links: list[Link] = []
    for i in range(count):
        parent = -1 if i == 0 else int(rng.choice([i - 1, rng.integers(i)]))
        kind = str(
            rng.choice(["revolute", "continuous", "prismatic", "fixed"], p=[0.4, 0.2, 0.3, 0.1])
        )
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        moments = 0.01 * rng.uniform(1, 2, 3)  # any two exceed the third
        massless = i > 0 and kind == "fixed" and rng.random() < 0.3
        link = Link(
            f"{i:02}", parent, kind if i else "root",
            rng.uniform(-0.3, 0.3, 3), rng.uniform(-3, 3, 3), axis,
            0.0 if massless else float(rng.uniform(0.1, 2)), rng.uniform(-0.1, 0.1, 3),
            rng.uniform(-3, 3, 3), moments, bool(rng.random() < 0.3),
        )  # fmt: skip
        links.append(link)
    return with_mimics(rng, links)


def with_mimics(rng: np.random.Generator, links: list[Link]) -> list[Link]:
    """The same tree with mimic joints; URDF's reader wants a leader before those that follow it."""
    found, leaders = list(links), list[int]()
    for i in depth_first(links, 0):
        link = links[i]
        if link.kind in ("root", "fixed"):
            continue
        endless = link.kind == "continuous"
        able = [k for k in leaders if (links[k].kind == "continuous") == endless]
        if not able or rng.random() < 0.5:
            leaders.append(i)
            continue
        multiplier = float(rng.choice([-1, 1]) * rng.choice([1.0, rng.uniform(0.1, 2)]))
        own = vars(link) | {"leader": int(rng.choice(able)), "actuated": False}
        found[i] = Link(**(own | {"multiplier": multiplier, "offset": float(rng.uniform(-1, 1))}))
    return found


def depth_first(links: list[Link], at: int) -> list[int]:
    """Numbers of the links at and below one of them, as URDF's reader visits them."""
    below = [k for k in range(len(links)) if links[k].parent == at]
    return [at, *(i for k in below for i in depth_first(links, k))]


def random_mechanisms(rng: np.random.Generator) -> list[Mechanism]:
    """One mechanism or two, and sometimes a free box that stands before them."""
    found = []
    if rng.random() < 0.3:
        found.append(Mechanism("box", random_links(rng, 1), "floating", False))
    for name in ("arm", "hand")[: rng.integers(1, 3)]:
        base = str(rng.choice(["fixed", "floating", "planar"]))
        links = random_links(rng, int(rng.integers(2, 11)))
        found.append(Mechanism(name, links, base, bool(rng.random() < 0.5)))
    return found


def words(numbers: np.ndarray) -> str:
    """Numbers in shortest round-trip decimal."""
    return " ".join(repr(float(x)) for x in numbers)


def urdf(mechanism: Mechanism) -> str:
    """Its URDF's text."""
    text = ""
    for link in mechanism.links:
        text += f'<link name="l{link.name}">'
        if link.mass:
            x, y, z = (repr(float(moment)) for moment in link.moments)
            text += f'<inertial><origin xyz="{words(link.com)}" rpy="{words(link.com_rpy)}"/>'
            text += f'<mass value="{link.mass!r}"/><inertia ixx="{x}" iyy="{y}" izz="{z}" '
            text += 'ixy="0" ixz="0" iyz="0"/></inertial>'
        text += "</link>"
        if link.kind == "root":
            continue
        text += f'<joint name="{link.joint}" type="{link.kind}"><parent link="l{link.parent:02}"/>'
        text += f'<child link="l{link.name}"/><axis xyz="{words(link.axis)}"/>'
        text += f'<origin xyz="{words(link.xyz)}" rpy="{words(link.rpy)}"/>'
        text += '<limit lower="-3" upper="3" effort="1" velocity="1"/>'
        if link.leader is not None:
            text += f'<mimic joint="{mechanism.links[link.leader].joint}" '
            text += f'multiplier="{link.multiplier!r}" offset="{link.offset!r}"/>'
        text += "</joint>"
    return f'<robot name="r" version="1.1">{text}</robot>'


def cross_matrix(v: np.ndarray) -> np.ndarray:
    """[v x]."""
    x, y, z = v
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def about(axis: np.ndarray, angle: complex) -> np.ndarray:
    """Rotation about a unit axis, whose angle may be complex."""
    c, s = np.cos(angle), np.sin(angle)
    return c * np.eye(3) + s * cross_matrix(axis) + (1 - c) * np.outer(axis, axis)


def turned(rpy: np.ndarray) -> np.ndarray:
    """Rotation of fixed-axis roll, pitch and yaw."""
    X, Y, Z = np.eye(3)
    return about(Z, rpy[2]) @ about(Y, rpy[1]) @ about(X, rpy[0])


def of_quaternion(p: np.ndarray) -> np.ndarray:
    """Rotation of a unit quaternion [x y z w]."""
    v, w = p[:3], p[3]
    return (w * w - v @ v) * np.eye(3) + 2 * np.outer(v, v) + 2 * w * cross_matrix(v)


@dataclass(frozen=True)
class State:
    """Where a mechanism is: the pose of its base, and the position of each joint."""

    quaternion: np.ndarray
    R: np.ndarray
    t: np.ndarray
    positions: list[float]


Poses = list[tuple[np.ndarray, np.ndarray]]


def poses(mechanism: Mechanism, state: State, moving: str | None) -> Poses:
    """R and t of each link; the coordinate of that name has made an imaginary step."""
    R, t = state.R, state.t
    if moving is not None and moving.startswith("base."):
        turns, axis = moving.startswith("base.r"), np.eye(3)["xyz".index(moving[-1])]
        t = t + (0 if turns else 1j * STEP) * (R @ axis)
        R = R @ (np.eye(3) + (1j * STEP if turns else 0) * cross_matrix(axis))
    found = [(R, t)]
    for link in mechanism.links[1:]:
        at = mechanism.links.index(link) if link.leader is None else link.leader
        position: complex = state.positions[at]
        if moving == mechanism.links[at].joint:
            position += 1j * STEP
        position = link.multiplier * position + link.offset
        R, t = found[link.parent]
        R, t = R @ turned(link.rpy), t + R @ link.xyz
        if link.kind == "prismatic":
            t = t + position * (R @ link.axis)
        elif link.kind != "fixed":
            R = R @ about(link.axis, position)
        found.append((R, t))
    return found


def jacobians(mechanism: Mechanism, state: State, names: list[str]) -> np.ndarray:
    """J of each link, shape (links, 6, n): its origin's velocity, then its angular velocity."""
    J = np.zeros((len(mechanism.links), 6, len(names)))
    for k, name in enumerate(names):
        for link, (R, t) in enumerate(poses(mechanism, state, name)):
            W = (R.imag / STEP) @ R.real.T  # [omega x]
            J[link, :, k] = [*(t.imag / STEP), W[2, 1], W[0, 2], W[1, 0]]
    return J


def dynamics(mechanism: Mechanism, at: Poses, J: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mass matrix and gravity's force."""
    M, force = np.zeros((J.shape[2], J.shape[2])), np.zeros(J.shape[2])
    for link, (R, _), (J_t, J_w) in zip(
        mechanism.links, at, J.reshape(len(J), 2, 3, J.shape[2]), strict=True
    ):
        J_c = J_t - cross_matrix(R @ link.com) @ J_w
        axes = R @ turned(link.com_rpy)
        M += link.mass * J_c.T @ J_c
        if link.mass:
            M += J_w.T @ axes @ np.diag(link.moments) @ axes.T @ J_w
        force += link.mass * J_c.T @ np.array(GRAVITY)
    return M, force


def root_centre(mechanism: Mechanism) -> np.ndarray:
    """Centre of mass, in the root's frame, of the root and of the links that are welded to it."""
    welded = {0: (np.eye(3), np.zeros(3))}
    for i, link in enumerate(mechanism.links):
        if link.kind == "fixed" and link.parent in welded:
            R, t = welded[link.parent]
            welded[i] = R @ turned(link.rpy), t + R @ link.xyz
    links = mechanism.links
    total = sum(links[i].mass for i in welded)
    return (
        np.sum([links[i].mass * (R @ links[i].com + t) for i, (R, t) in welded.items()], axis=0)
        / total
    )
