"""Scenes with bodies: URDF texts and the systems that they make."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.model.system import Body, System
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.placed_shape import HalfSpace, PlacedShape, PointCloud, Shape
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.solve.backends import NONE


def words(values: ArrayLike) -> str:
    """Numbers in shortest decimal, which reads back as the same float64, spaces between them."""
    return " ".join(repr(float(x)) for x in np.ravel(values))


def link_text(
    name: str, mass: float, inertia: ArrayLike, shape: str = "", com: ArrayLike = (0, 0, 0)
) -> str:
    """One link of a URDF.

    Parameters
    ----------
    name : str
    mass : float
        [kg].
    inertia : array_like, shape (3,) or (3, 3)
        Principal moments along the link's axes, or the inertia about its centre of mass [kg m^2].
    shape : str
        The URDF of its collision geometry at the link's origin, e.g. ``<sphere radius="0.1"/>``.
    com : array_like, shape (3,)
        Centre of mass in the link's frame [m].
    """
    about = np.diag(inertia) if np.ndim(inertia) == 1 else np.asarray(inertia)
    moments = " ".join(
        f'i{"xyz"[i]}{"xyz"[j]}="{words(about[i, j])}"' for i in range(3) for j in range(i, 3)
    )
    collision = f"<collision><geometry>{shape}</geometry></collision>" if shape else ""
    return (
        f'<link name="{name}"><inertial><origin xyz="{words(com)}"/><mass value="{mass!r}"/>'
        f"<inertia {moments}/></inertial>{collision}</link>"
    )


def robot_text(*elements: str) -> str:
    """A URDF of some links and joints."""
    return f'<robot name="scene" version="1.1">{"".join(elements)}</robot>'


def body_text(mass: float, inertia: ArrayLike, shape: str = "", com: ArrayLike = (0, 0, 0)) -> str:
    """A URDF of one link, named body; its parameters are those of :func:`link_text`."""
    return robot_text(link_text("body", mass, inertia, shape, com))


def joint_text(
    name: str,
    kind: str,
    parent: str,
    child: str,
    axis: str = "1 0 0",
    origin: str = "0 0 0",
    rpy: str = "0 0 0",
    more: str = "",
) -> str:
    """One joint of a URDF; its limits play no role in this model."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{origin}" rpy="{rpy}"/><axis xyz="{axis}"/>{more}'
        '<limit lower="-10" upper="10" effort="1" velocity="1"/></joint>'
    )


RAIL = robot_text(
    link_text("rail", 1.0, (1, 1, 1)),
    link_text("finger", 0.1, (1e-4, 1e-4, 1e-4)),
    joint_text("slide", "prismatic", "rail", "finger"),
)
"""A finger that slides along x."""


def system_of(texts: Mapping[str, str], **settings: Mapping[str, Any]) -> System:
    """A system of bodies given as URDF texts.

    Parameters
    ----------
    texts : mapping of str to str
        Body -> URDF.
    settings : mapping
        Body -> further arguments of :class:`~quasistatic_ref.model.body.Body`; bodies float freely
        where nothing else is said.
    """
    with TemporaryDirectory() as folder:
        bodies = []
        for name, text in texts.items():
            path = Path(folder) / f"{name}.urdf"
            path.write_text(text, encoding="utf-8")
            bodies.append(Body(name, path, **({"base": "floating"} | dict(settings.get(name, {})))))
        return System(bodies)


def world_plane(normal: ArrayLike = (0, 0, 1)) -> PlacedShape:
    """A half-space fixed in the world, its surface through the origin."""
    shape = HalfSpace(np.array(normal, dtype=np.float64), 0.0)
    return PlacedShape.in_world("floor", shape)


def on_link(system: System, link: str, shape: Shape) -> PlacedShape:
    """A shape at the origin of a link."""
    return PlacedShape(link, system.link(link), np.eye(3), np.zeros(3), shape)


def cloud_on(system: System, link: str, points: ArrayLike) -> PlacedShape:
    """Points fixed to a link, in its frame [m]."""
    return on_link(system, link, PointCloud(np.array(points, dtype=np.float64)))


def simulator_of(
    system: System,
    pairs: Sequence[ContactPair],
    h: float,
    K_q: ArrayLike | None = None,
) -> Simulator:
    """A simulator that asks no solver: every step is exact from a cold start."""
    K = np.zeros((system.n_a, system.n_a)) if K_q is None else np.asarray(K_q, dtype=np.float64)
    return Simulator(system, pairs, h=h, K_q=K, backend=NONE)


def steps_of(
    simulator: Simulator,
    steps: int,
    *,
    q: Array | None = None,
    velocity: ArrayLike = (),
    force: Array | float = 0.0,
) -> list[StepResult]:
    """Steps in sequence under a constant force; each result holds the q after it.

    Parameters
    ----------
    simulator : Simulator
    steps : int
    q : ndarray, shape (n_q,), optional
        Where to start.
    velocity : array_like, shape (n_a,)
        Of the targets [m/s, rad/s], which start where the actuated joints do; scalar joints only.
    force : float or ndarray, shape (n_v,)
        External generalised force [N, N m].
    """
    q = simulator.system.q_start if q is None else q
    start = q[: simulator.system.n_q_a]
    results = []
    for k in range(steps):
        target = start + (k + 1) * simulator.h * np.asarray(velocity, dtype=np.float64)
        results.append(simulator.step(q, target, force))
        q = results[-1].q
    return results
