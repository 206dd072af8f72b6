"""The contact points of a step of many bodies."""

import numpy as np

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.step.arrays import Array, Indices, read_only
from quasistatic_ref.step.contacts import Contacts


class SparseContacts(Contacts):
    """The contact points of a step of many bodies, which keep J without its zeros.

    Parameters
    ----------
    name, phi, n, d1, d2, mu_v, mu_omega, rows
        As in :class:`~quasistatic_ref.step.contacts.Contacts`.
    blocks : Blocks
        The columns of J that are not zero.
    """

    blocks: Blocks

    def __init__(
        self,
        name: tuple[str, ...],
        phi: Array,
        n: Array,
        d1: Array,
        d2: Array,
        blocks: Blocks,
        mu_v: Array,
        mu_omega: Array,
        rows: Indices,
    ) -> None:
        given = {"name": name, "phi": phi, "n": n, "d1": d1, "d2": d2, "blocks": blocks}
        for key, value in {**given, "mu_v": mu_v, "mu_omega": mu_omega, "rows": rows}.items():
            object.__setattr__(self, key, value)
        self._check_all_but_J()
        if len(blocks.J) != self.n_c:
            problem = f"must have {self.n_c} contacts"
            raise StepDataError(problem, field="contacts.blocks", value=len(blocks.J))

    def raised(self, s: Array) -> Contacts:
        """These contacts with phi + s, shape (n_c,) [m], in the place of phi."""
        fields = {name: getattr(self, name) for name in self.kept()}
        return SparseContacts(**fields | {"phi": self.phi + s})

    @classmethod
    def kept(cls) -> tuple[str, ...]:
        """As of any contacts, with the blocks in the place of J."""
        return tuple("blocks" if name == "J" else name for name in super().kept())

    @property
    def J(self) -> Array:
        """All of J, shape (n_c, 4, n_v): formed whenever it is read, and not kept."""
        return read_only(self.blocks.dense())

    @property
    def kept_J(self) -> Array:
        """The columns of J that are not zero, shape (n_c, 4, w)."""
        return self.blocks.J

    @property
    def kept_columns(self) -> Indices:
        """Those of the blocks, shape (n_c, w)."""
        return self.blocks.column

    @property
    def n_v(self) -> int:
        """Number of columns of J."""
        return self.blocks.n_v

    def entries(self) -> tuple[Indices, Indices, Array]:
        """The columns of J that are not zero: their contacts and coordinates, and they, (k, 4)."""
        contact, place = np.nonzero(self.blocks.J.any(axis=1))
        return contact, self.blocks.column[contact, place], self.blocks.J[contact, :, place]

    def moving(self) -> bytes:
        """Which coordinates move which contacts, and where they are kept, as bytes."""
        return self.blocks.column.tobytes() + super().moving()

    def columns(self, contacts: Indices, coordinates: Indices) -> Array:
        """J of some contacts, those columns of it, shape (k, 4, n)."""
        return self.blocks.columns(contacts, coordinates)

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of each contact, shape (n_c, 4) [m, m, m, rad]."""
        return self.blocks.motion(delta_q)
