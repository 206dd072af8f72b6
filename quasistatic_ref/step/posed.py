"""Steps as a simulator poses them: right by construction, and so not checked number by number.

To read they are a :class:`~quasistatic_ref.step.data.StepData` like any other, equal to one of the
same numbers. Whatever is made of their parts by hand, also through ``replace``, is checked.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.contacts import Contacts, SparseContacts
from quasistatic_ref.step.data import StepData, no_rows

FIELDS = tuple(field.name for field in fields(StepData))


@dataclass(frozen=True, eq=False)
class PosedContacts(Contacts):
    """Contacts of a layout that was checked, at points and normals that were measured."""

    def __post_init__(self) -> None:
        for array in (self.phi, self.n, self.d1, self.d2, self.J):
            array.setflags(write=False)

    @classmethod
    def compared_as(cls) -> type:
        """They are compared as :class:`~quasistatic_ref.step.contacts.Contacts`."""
        return Contacts


class PosedStep(StepData):
    """A step of the K_q and M_u of a simulator, which were checked; without rows of a user's."""

    def __init__(
        self,
        h: float,
        K_q: Array,
        M_u: Array,
        tau_a: Array,
        tau_u: Array,
        delta_q_bar_a: Array,
        contacts: Contacts | SparseContacts,
        cone: str,
    ) -> None:
        for array in (tau_a, tau_u, delta_q_bar_a):
            array.setflags(write=False)
        extra = no_rows(tau_a.size + tau_u.size)
        given = (h, K_q, M_u, tau_a, tau_u, delta_q_bar_a, contacts, cone, extra)
        for key, value in zip(FIELDS, given, strict=True):
            object.__setattr__(self, key, value)

    @classmethod
    def compared_as(cls) -> type:
        """It is compared as :class:`~quasistatic_ref.step.data.StepData`."""
        return StepData
