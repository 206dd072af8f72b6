"""Friction of coordinates, and of a planar base on its floor, by private rises of a step, (R40)."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import InputError
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, read_only
from quasistatic_ref.numbers.ordered import product
from quasistatic_ref.optional.extensions.extension import Rises
from quasistatic_ref.optional.extensions.urdf_joints import urdf_joints
from quasistatic_ref.shapes.placed_shape import HalfSpace, PlacedShape, PointCloud
from quasistatic_ref.step.data import Extra, StepData

LIGHT: Final = 1e-6
"""Mass of a private rise over that of what it lies on [-]: sliding is slower by as much, (R40)."""

WAYS = (1.0, -1.0)
"""r + delta_q_i >= 0 and r - delta_q_i >= 0."""


def with_rises(step: StepData, rises: Rises) -> StepData:
    """A step with private rises as its last coordinates, and their rows as its last rows."""
    p = len(rises)
    c = len(rises.coordinates)
    if not p:
        return step
    n_v = step.n_v
    n_u = step.n_u
    contacts = step.contacts
    columns = np.arange(n_v, n_v + p)
    J = _wider(contacts.J, p)
    J[rises.contacts, :3, columns[c:]] = contacts.n[rises.contacts]
    rows = np.zeros((2, c, n_v + p))
    rows[:, np.arange(c), columns[:c]] = 1.0
    rows[:, np.arange(c), rises.coordinates] = np.array(WAYS)[:, None]
    M_u = np.zeros((n_u + p, n_u + p))
    M_u[:n_u, :n_u] = step.M_u
    M_u[range(n_u, n_u + p), range(n_u, n_u + p)] = rises.masses
    extra = step.extra
    H, g = extra.cost or (None, None)
    names = tuple(f"rise {way} delta_q[{i}]" for way in "+-" for i in rises.coordinates)
    # What is added is right by construction; the rest is that of a step.
    of_step = {
        "M_u": read_only(M_u),
        "tau_u": read_only(np.concatenate([step.tau_u, -rises.loads])),
        "contacts": contacts.with_fields(J=read_only(J)),
        "extra": Extra(
            extra.names + names,
            np.concatenate([_wider(extra.A, p), *rows]),
            np.concatenate([extra.b, np.zeros(2 * c)]),
            H=None if H is None else np.pad(H, (0, p)),
            g=None if g is None else np.pad(g, (0, p)),
        ),
    }
    return step.with_fields(**of_step)


def _wider(array: Array, p: int) -> Array:
    """An array with p further columns of zeros."""
    return np.concatenate([array, np.zeros((*array.shape[:-1], p))], axis=-1)


def private_rises(
    system: System,
    pairs: Sequence[ContactPair],
    *,
    h: float,
    K_q: Array,
    gravity: Sequence[float] | Array,
    friction: Mapping[str, float],
    support: Mapping[str, tuple[float, float]],
) -> tuple[tuple[ContactPair, ...], Rises]:
    """Pairs with a contact more for each support, and the rises of an extension.

    Each rise weighs 1e-6 of what it lies on at the start: M_u of its coordinate (of an actuated
    one, h^2 K_q), or its body.

    Parameters
    ----------
    system : System
    pairs : sequence of ContactPair
        Of the simulator.
    h : float
        Time step [s].
    K_q : ndarray, shape (n_a, n_a)
        [N/m, N m/rad]
    gravity : array_like, shape (3,)
        [m/s^2], world frame.
    friction : mapping of str to float
        Force at which a coordinate slides, by its name: ``cabinet/drawer``, ``slider/base.x``
        [N, N m].
    support : mapping of str to (float, float)
        mu_v [-] and mu_omega [m] of bodies with a planar base on their floor, by their names: at
        one point below the centre of mass as it is at the start, which bears the body's weight.

    Raises
    ------
    InputError
        If gravity does not press such a body down.
    """
    friction = {name: load for name, load in friction.items() if load}
    numbers = {coordinate.name: i for i, coordinate in enumerate(system.coordinates)}
    coordinates = [numbers[name] for name in friction]
    heavy = np.concatenate([h**2 * np.diag(K_q), np.diag(system.M_u(system.q_start))])
    supports = tuple(_support(system, name, *rubs) for name, rubs in support.items())
    bodies = [system.mass(name) for name in support]
    weights = [-mass * gravity[2] for mass in bodies]
    if any(weight <= 0 for weight in weights):
        problem = "needs a body with a mass, and gravity that presses it down"
        raise InputError(problem, field="support", value=list(support))
    first = sum(pair.n_c for pair in pairs)
    rises = Rises(
        loads=np.array([*friction.values(), *weights]),
        masses=LIGHT * np.array([*heavy[coordinates], *bodies]),
        coordinates=np.array(coordinates, dtype=np.int64),
        contacts=np.arange(first, first + len(supports)),
    )
    return (*pairs, *supports), rises


def _support(system: System, name: str, mu_v: float, mu_omega: float) -> ContactPair:
    """The contact of a planar base with the horizontal plane through its origin."""
    root = system.link(name)
    at = system.kinematics(system.q_start)
    links = [i for i, link in enumerate(system.links) if link.startswith(f"{name}/")]
    centres = np.einsum("lij,lj->li", at.R[links], system.centres[links]) + at.t[links]
    centre = np.average(centres, axis=0, weights=system.masses[links]) - at.t[root]
    below = product(at.R[root].T, centre) * [1.0, 1.0, 0.0]
    plane = HalfSpace(np.array([0.0, 0.0, 1.0]), at.t[root, 2])
    floor = PlacedShape(f"floor of {name}", 0, np.eye(3), np.zeros(3), plane)
    foot = PlacedShape(f"foot of {name}", root, np.eye(3), np.zeros(3), PointCloud(below[None]))
    rows = 6 if mu_omega else 4
    return ContactPair(f"support of {name}", floor, foot, mu_v, mu_omega, rows, 1)


def urdf_friction(system: System, name: str) -> dict[str, float]:
    """What ``<dynamics friction>`` says of the joints of a body, by coordinate [N, N m].

    A joint that mimics another adds its own times the size of its multiplier to that of the other.
    """
    frictions: dict[str, float] = {}
    for joint in urdf_joints(system, [name]):
        dynamics = joint.tag.perhaps("dynamics")
        if dynamics is not None:
            friction = abs(joint.multiplier) * dynamics.number("friction", default=0.0)
            frictions[joint.leader] = frictions.get(joint.leader, 0.0) + friction
    return frictions
