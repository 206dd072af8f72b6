"""The un-actuated block M_u of the mass matrix: whether it is constant, and not singular."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.coordinates import Coordinate, Joint, joint_key
from quasistatic_ref.step.arrays import Array


def constant_mass(model: Any, joints: Sequence[Joint]) -> bool:
    """Whether M_u is the same at every q: every un-actuated joint is a lone rigid body's base.

    The mass matrix of a free rigid body is constant in the body's own frame, unless a moving joint
    connects another link to the body.
    """
    free = [joint for joint in joints if not joint.actuated]
    if any(joint.kind != "floating" for joint in free):
        return False
    parents = list(model.parents)
    return not any(model.getJointId(joint_key(joint.name)) in parents for joint in free)


def regular(M: Array) -> bool:
    """Whether each matrix M, shape (..., n, n) [any unit], has a Cholesky factor in float64."""
    try:
        np.linalg.cholesky(M)
    except np.linalg.LinAlgError:
        return False
    return True


def check_mass(M_u: Array, free: Sequence[Coordinate], bodies: Iterable[str]) -> None:
    """Refuse a body whose M_u is singular: Eq. :eq:`eq-13` needs it positive definite.

    Parameters
    ----------
    M_u : ndarray, shape (n_u, n_u)
        [kg, kg m, kg m^2].
    free : sequence of Coordinate, length n_u
        The un-actuated ones.
    bodies : iterable of str

    Raises
    ------
    ModelError
    """
    for body in bodies:
        own = [k for k, c in enumerate(free) if c.name.startswith(f"{body}/")]
        if not regular(M_u[np.ix_(own, own)]):
            problem = (
                "its mass matrix M_u is singular in float64 at the start: an un-actuated "
                "coordinate moves next to no mass"
            )
            names = [free[k].name for k in own]
            raise ModelError(problem, field=body, value=names)
