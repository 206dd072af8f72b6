"""Friction as several optional parts read it, in no step of the core."""

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.contacts import Contacts


def cone_matrix(name: str) -> Array:
    """The ``matrix`` of a polyhedral cone, (R, 4) [-].

    Raises
    ------
    StepDataError
        If there is no such cone.
    InputError
        If it is no polyhedron: it has no rows.
    """
    if not cone(name).polyhedral:
        raise InputError("has no rows", field="cone", value=name)
    return cone(name).matrix


def scaled_by(contacts: Contacts) -> Array:
    """(1, mu_v, mu_v, mu_omega), by which cones multiply gap, slips and spin, (n_c, 4) [-, m]."""
    return np.concatenate([np.ones((contacts.n_c, 1)), contacts.mu], axis=1)


def slip_norm(scaled: Array, name: str) -> Array:
    """The norm of slips in a cone, shape (...) [m].

    Parameters
    ----------
    scaled : ndarray, shape (..., 3)
        Slips along d1 and d2, and spin, times mu of contacts [m].
    name : str
        The cone.
    """
    kind = cone(name)
    if not kind.polyhedral:
        return np.asarray(np.linalg.norm(scaled, axis=-1))
    # The largest of the rows without the gap: of the pyramid, |mu_v slip_1|, ..., |mu_omega spin|.
    return np.asarray((scaled @ kind.matrix[:, 1:].T).max(axis=-1, initial=0.0))
