"""The contact points of a step of many bodies."""

from dataclasses import dataclass

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.optional.large.blocks import Blocks
from quasistatic_ref.step.arrays import Array, Indices, read_only
from quasistatic_ref.step.contacts import Contacts, Points


@dataclass(frozen=True, eq=False, repr=False)
class SparseContacts(Points):
    """The contact points of a step of many bodies, which keep J without its zeros.

    Parameters
    ----------
    name, phi, n, d1, d2, mu_v, mu_omega, rows
        As in :class:`~quasistatic_ref.step.contacts.Contacts`.
    blocks : Blocks
        The columns of J that are not zero.
    """

    name: tuple[str, ...]
    phi: Array
    n: Array
    d1: Array
    d2: Array
    blocks: Blocks
    mu_v: Array
    mu_omega: Array
    rows: Indices

    def __post_init__(self) -> None:
        self._check()
        if len(self.blocks.J) != self.n_c:
            problem = f"must have {self.n_c} contacts"
            raise StepDataError(problem, field="contacts.blocks", value=len(self.blocks.J))

    @property
    def J(self) -> Array:
        """All of J, shape (n_c, 4, n_v): formed whenever it is read, and not kept."""
        return read_only(self.blocks.dense())

    @property
    def n_v(self) -> int:
        """Number of columns of J."""
        return self.blocks.n_v

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of each contact, shape (n_c, 4) [m, m, m, rad]."""
        return self.blocks.motion(delta_q)

    def dense(self) -> Contacts:
        """The same contacts with all of J."""
        own = (self.name, self.phi, self.n, self.d1, self.d2, self.J)
        return Contacts(*own, self.mu_v, self.mu_omega, self.rows)
