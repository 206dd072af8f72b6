"""The backends of `fast`: the quickest by default, each by its own interface where it has one."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.optional.fast.native import native_backends
from quasistatic_ref.solve.backends import (
    BACKENDS,
    DEFAULT,
    check_backend,
    check_certify,
)
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.groups import labels
from quasistatic_ref.tolerances import DENSE_BELOW, DENSE_BELOW_PROOFS, SPARSE_FROM_PIQP

if TYPE_CHECKING:
    from quasistatic_ref.contact.pairs import ContactPair
    from quasistatic_ref.model.system import System

DEFAULT_OF_FAST = "daqp" if find_spec("daqp") else DEFAULT
"""Backend of small steps: the fastest; certified steps have the same bits with any backend."""
DEFAULT_OF_LARGE = "piqp" if find_spec("piqp") else DEFAULT
"""Backend of large steps: with sparse matrices, in half of the time that DEFAULT takes."""


class EntriesOfJ(NamedTuple):
    """Entries of the dense J of steps whose contacts may be in blocks; 0 where they may not.

    Parameters
    ----------
    every : int
        4 n_c n_v.
    of_group : int
        The same of the group in which it is largest, whatever touches what.
    coordinates : int
        Those of the largest group.
    """

    every: int = 0
    of_group: int = 0
    coordinates: int = 0


def entries_of_J(system: System, pairs: Sequence[ContactPair], ordinary: bool) -> EntriesOfJ:
    """The entries in a scene.

    Parameters
    ----------
    system : System
    pairs : sequence of ContactPair
    ordinary : bool
        Whether the steps are the model's own: neither extended nor under Coulomb's law.
    """
    if not (ordinary and system.constant_mass_matrix):
        return EntriesOfJ()
    column_map = system.column_map
    moves = column_map.moves[:, 0] > 0
    moved = [moves[pair.alpha.link] | moves[pair.beta.link] for pair in pairs]
    pair, joint = np.nonzero(np.reshape(moved, (len(pairs), moves.shape[1])))
    of_coordinate, of_pair = labels(system.n_v, len(pairs), pair, column_map.owner[joint])
    n_c = np.array([one.n_c for one in pairs], dtype=np.int64)
    sizes = np.bincount(of_coordinate)
    contacts = np.bincount(of_pair, n_c, len(sizes))
    every = 4 * int(n_c.sum()) * system.n_v
    of_group = 4 * int((contacts * sizes).max(initial=0))
    return EntriesOfJ(every, of_group, int(sizes.max(initial=0)))


def fast_backend(
    name: str | None, cone_name: str, certify: str = "full", entries: EntriesOfJ | None = None
) -> str:
    """The name of a backend, or of the default where none is named; checked.

    Parameters
    ----------
    name : str or None
    cone_name : str
    certify : str
    entries : EntriesOfJ, optional
        By default those of a small scene.

    Raises
    ------
    BackendError, InputError
        As of :func:`~quasistatic_ref.solve.backends.check_backend`.
    """
    if name is None:
        name = default_backend(cone_name, certify, entries or EntriesOfJ())
    if name in native_backends(cone_name):  # also those that CVXPY does not reach
        check_certify(name, certify)
    else:
        check_backend(name, cone_name, certify)
    return name


def default_backend(cone_name: str, certify: str, entries: EntriesOfJ) -> str:
    """The backend where none is named; arguments are those of :func:`fast_backend`."""
    if not cone(cone_name).polyhedral:
        return DEFAULT
    large = {
        "off": entries.of_group >= DENSE_BELOW,
        "residual": entries.every >= SPARSE_FROM_PIQP,
        "full": entries.of_group >= DENSE_BELOW_PROOFS,
    }
    return DEFAULT_OF_LARGE if large[certify] else DEFAULT_OF_FAST


def sparse_from(name: str, cone_name: str) -> int:
    """Entries of J, 4 n_c n_v, from which steps are handed over in blocks; 0 if they never are.

    They can be by the backend's own interface, where the cone is polyhedral.
    """
    may = name in native_backends(cone_name) and cone(cone_name).polyhedral
    return BACKENDS[name].sparse if may else 0
