"""The rows of contacts by their own columns: source/rows.c."""

from collections.abc import Callable

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.compiled.library import addresses, function
from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.contacts import Contacts


def inequalities(_: None) -> Callable[[Contacts, str, Mask], tuple[Array, Array] | None]:
    """``contact_inequalities`` of the pyramid in C.

    It returns A, shape (m, w), and b, (m,), or None.
    """
    compiled = function("pyramid_rows")

    def answer(contacts: Contacts, name: str, mask: Mask) -> tuple[Array, Array] | None:
        if name != PYRAMID:
            return None
        n_c, _, w = contacts.own.shape
        m = np.count_nonzero(mask)
        sizes, A, b = np.array([n_c, w]), np.empty((m, w)), np.empty(m)
        of = contacts
        read = sizes, of.n, of.d1, of.d2, of.own, of.mu, of.phi, mask
        compiled(*addresses(read, (A, b)))
        return A, b

    return answer


def trials_of_inequalities() -> list[tuple[None, tuple[Contacts, str, Mask]]]:
    """Contacts with six and with four rows."""
    numbers = np.sin(np.arange(1.0, 200.0))
    n, d1, d2 = numbers[:36].reshape(3, 4, 3)
    mu = np.array([[0.5, 0.5, 0.01], [0.3, 0.3, 0.0], [0.0, 0.0, 0.02], [1.1, 1.1, 0.3]])
    phi = np.array([0.0, -0.01, 0.3, 1e-9])
    own = numbers[36:148].reshape(4, 4, 7)
    contacts = Contacts.unchecked(phi=phi, n=n, d1=d1, d2=d2, own=own, mu=mu)
    mask = np.arange(6) < np.array([6, 4, 6, 4])[:, None]
    return [(None, (contacts, PYRAMID, mask))]
