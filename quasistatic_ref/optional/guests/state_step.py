"""Contacts and coordinates of a MuJoCo state, as a step has them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.step.arrays import Array, freeze_copies
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.tolerances import DEEP


@dataclass(frozen=True, eq=False)
class Coordinates(Plain):
    """Where the coordinates of a step are in MuJoCo, and what the step leaves out.

    Parameters
    ----------
    names : tuple of str, length n_v
        ``joint[knee]``, ``joint[cap].rx``, ``friction of joint[knee]``.
    T : ndarray, shape (nv, n_v)
        MuJoCo's displacement, per unit of delta_q [-]: what ``mj_integratePos`` takes is T delta_q,
        with dt = 1.
    left_out : tuple of str
        What the step does not have, or holds as it is: one sentence for each.
    quasi_dynamic_number : float
        Largest v / (mu_v g h) of the contacts with friction, of the speed v that was dropped [-]:
        the drag of the model on that motion, over the friction. It is inf without gravity.
    """

    names: tuple[str, ...]
    T: Array
    left_out: tuple[str, ...]
    quasi_dynamic_number: float

    def __post_init__(self) -> None:
        freeze_copies(self, "T")


class StateContact(NamedTuple):
    """A contact of a state: one point of two geoms.

    Parameters
    ----------
    name : str
    pair : str
        What touches, as of all contacts of the two geoms.
    bodies : tuple of str
        Alpha's and beta's; ``"world"`` for what cannot move.
    phi : float
        [m].
    closed : bool
        Whether its gap counts as zero, unless gaps are taken as they are.
    frame : ndarray, shape (3, 3)
        n, d1, d2 [-].
    J : ndarray, shape (4, nv)
        Of Eq. :eq:`eq-3`, along MuJoCo's velocities.
    mu_v, mu_omega : float
        [-, m].
    rows : int
    """

    name: str
    pair: str
    bodies: tuple[str, str]
    phi: float
    closed: bool
    frame: Array
    J: Array
    mu_v: float
    mu_omega: float = 0.0
    rows: int = 4

    def slip(self, v: Array) -> float:
        """Speed of one surface along the other at a velocity v, (nv,) [m/s]."""
        return float(np.linalg.norm(self.frame[1:] @ (self.J @ v)[:3]))

    def spin(self, v: Array) -> float:
        """Rate about the normal at a velocity v, (nv,) [rad/s]."""
        return float(abs(self.J[3] @ v))


def contacts_of(every: Sequence[StateContact], T: Array, as_is: bool) -> Contacts:
    """Contacts of a step, of whose coordinates T, (nv, n_v), makes MuJoCo's velocities [-]."""
    frames = np.array([contact.frame for contact in every]).reshape(-1, 3, 3)
    phi = np.array([contact.phi for contact in every])
    closed = np.array([contact.closed for contact in every], dtype=bool)
    return Contacts(
        name=tuple(contact.name for contact in every),
        phi=phi if as_is else np.where(closed, 0.0, phi),
        n=frames[:, 0],
        d1=frames[:, 1],
        d2=frames[:, 2],
        J=np.array([contact.J for contact in every]).reshape(-1, 4, len(T)) @ T,
        mu_v=np.array([contact.mu_v for contact in every]),
        mu_omega=np.array([contact.mu_omega for contact in every]),
        rows=np.array([contact.rows for contact in every], dtype=np.int64),
    )


def dropped(v: Array, every: Sequence[StateContact]) -> Iterator[str]:
    """What any step leaves out: a velocity v, (nv,), and the depth of bodies in each other."""
    for contact in every:
        if contact.phi < -DEEP:
            depth = f"its bodies penetrate by {-1e3 * contact.phi:.3g} mm"
            yield f"contact[{contact.name}]: {depth}"
    if v.any():
        yield f"velocity: dropped; its largest component is {np.abs(v).max():.2g}"


def quasi_dynamic_number(
    every: Sequence[StateContact], v: Array, gravity: Array, h: float
) -> float:
    """Largest v / (mu_v g h) of closed contacts, v the speed at which one slides [-].

    Parameters
    ----------
    every : sequence of StateContact
    v : ndarray, shape (nv,)
        MuJoCo's velocity.
    gravity : ndarray, shape (3,)
    h : float
    """
    rubbing = [contact for contact in every if contact.closed and contact.mu_v]
    fastest = max((contact.slip(v) / contact.mu_v for contact in rubbing), default=0.0)
    g = float(np.linalg.norm(gravity))
    if not fastest:
        return 0.0
    return fastest / (g * h) if g else np.inf
