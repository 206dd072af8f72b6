"""The backends of `fast`: the quickest by default, each by its own interface where it has one."""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

from quasistatic_ref.optional.fast.native import native_backends
from quasistatic_ref.solve.backends import (
    BACKENDS,
    DEFAULT,
    check_backend,
    check_certify,
)
from quasistatic_ref.step.cones import cone
from quasistatic_ref.tolerances import DENSE_BELOW, DENSE_BELOW_PROOFS, SPARSE_FROM_PIQP

if TYPE_CHECKING:
    from quasistatic_ref.model.system import System

DEFAULT_OF_FAST = "daqp" if find_spec("daqp") else DEFAULT
"""Backend of small steps: the fastest; certified steps have the same bits with any backend."""
DEFAULT_OF_LARGE = "piqp" if find_spec("piqp") else DEFAULT
"""Backend of large steps: with sparse matrices, in half of the time that DEFAULT takes."""


def fast_backend(name: str | None, cone_name: str, certify: str = "full", entries: int = 0) -> str:
    """The name of a backend, or of the default where none is named; checked.

    Parameters
    ----------
    name : str or None
    cone_name : str
    certify : str
    entries : int
        As of :func:`entries_of_J`.

    Raises
    ------
    BackendError, InputError
        As of :func:`~quasistatic_ref.solve.backends.check_backend`.
    """
    if name is None:
        name = default_backend(cone_name, certify, entries)
    if name in native_backends(cone_name):  # also those that CVXPY does not reach
        check_certify(name, certify)
    else:
        check_backend(name, cone_name, certify)
    return name


def entries_of_J(system: System, n_c: int, ordinary: bool) -> int:
    """Entries of the dense J of n_c contacts, 4 n_c n_v, where they may be in blocks; otherwise 0.

    Parameters
    ----------
    system : System
    n_c : int
    ordinary : bool
        Whether the steps are the model's own: neither extended nor under Coulomb's law.
    """
    may = ordinary and system.constant_mass_matrix
    return 4 * n_c * system.n_v if may else 0


def default_backend(cone_name: str, certify: str, entries: int) -> str:
    """The backend where none is named; arguments are those of :func:`fast_backend`."""
    if not cone(cone_name).polyhedral:
        return DEFAULT
    least = {"off": DENSE_BELOW, "residual": SPARSE_FROM_PIQP, "full": DENSE_BELOW_PROOFS}
    return DEFAULT_OF_LARGE if entries >= least[certify] else DEFAULT_OF_FAST


def sparse_from(name: str, cone_name: str) -> int:
    """Entries of J, 4 n_c n_v, from which steps are handed over in blocks; 0 if they never are.

    They can be by the backend's own interface, where the cone is polyhedral.
    """
    may = name in native_backends(cone_name) and cone(cone_name).polyhedral
    return BACKENDS[name].sparse if may else 0
