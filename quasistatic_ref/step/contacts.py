"""The contact points of one step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.plain import Plain
from quasistatic_ref.step.arrays import columns, freeze, names, numbers, read_only
from quasistatic_ref.step.blocks import Blocks
from quasistatic_ref.tolerances import ORTHONORMAL

Array = NDArray[np.float64]


class Points(Plain):
    """What contacts have, in whichever form their J is kept."""

    name: tuple[str, ...]
    phi: Array
    n: Array
    d1: Array
    d2: Array
    mu_v: Array
    mu_omega: Array
    rows: NDArray[np.int64]

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", names(self.name, "contacts.name"))
        n_c = len(self.name)
        for key in ("phi", "mu_v", "mu_omega"):
            freeze(self, key, (n_c,), "contacts")
        for key in ("n", "d1", "d2"):
            freeze(self, key, (n_c, 3), "contacts")
        self._check_rows(n_c)
        self._check_friction()
        self._check_frames()

    @property
    def n_c(self) -> int:
        """Number of contacts."""
        return len(self.name)

    @property
    def mu(self) -> Array:
        """(mu_v, mu_v, mu_omega) of each contact, shape (n_c, 3), 0 where it is not used."""
        mu_omega = np.where(self.rows == 6, self.mu_omega, 0.0)
        return np.stack([self.mu_v, self.mu_v, mu_omega], axis=1)

    def _check_rows(self, n_c: int) -> None:
        whole = isinstance(self.rows, np.ndarray) and self.rows.dtype == np.int64
        rows = self.rows if whole else numbers(self.rows, "contacts.rows")
        if rows.shape != (n_c,) or not ((rows == 4) | (rows == 6)).all():
            problem = "must be 4 or 6 for each contact"
            raise StepDataError(problem, field="contacts.rows", value=rows.tolist())
        object.__setattr__(self, "rows", read_only(rows.astype(np.int64)))

    def _check_friction(self) -> None:
        for key in ("mu_v", "mu_omega"):
            mu = getattr(self, key)
            if mu.min(initial=0.0) < 0:
                j = int(mu.argmin())
                field = f"contacts[{self.name[j]}].{key}"
                raise StepDataError("must be >= 0", field=field, value=float(mu[j]))

    def _check_frames(self) -> None:
        frame = np.array([self.d1, self.d2, self.n]).transpose(1, 0, 2)
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is no unit vector
            defect = np.abs(frame @ frame.transpose(0, 2, 1) - np.eye(3))
            good = (defect <= ORTHONORMAL).all(axis=(1, 2)) & (np.linalg.det(frame) > 0)
        if not good.all():
            j = int(good.argmin())
            raise StepDataError(
                "d1, d2, n must be a right-handed orthonormal frame",
                field=f"contacts[{self.name[j]}]",
                value=frame[j].tolist(),
            )


@dataclass(frozen=True, eq=False)
class Contacts(Points):
    """The contact points of one step.

    Parameters
    ----------
    name : tuple of str, length n_c
        A name for each contact, for messages.
    phi : ndarray, shape (n_c,)
        Signed distance [m], negative in penetration.
    n, d1, d2 : ndarray, shape (n_c, 3)
        Unit normal from alpha's body to beta's, and the tangents: {d1, d2, n} is dextral; world.
    J : ndarray, shape (n_c, 4, n_v)
        Contact Jacobian, Eq. :eq:`eq-3`: rows 0-2 the velocity of beta relative to alpha in the
        world frame [m], row 3 the relative spin about n [rad], each per unit of delta_q.
    mu_v : ndarray, shape (n_c,)
        Tangential friction coefficient [-], >= 0.
    mu_omega : ndarray, shape (n_c,)
        Torsional friction coefficient, a length [m], >= 0.
    rows : ndarray of int, shape (n_c,)
        6, or 4 for a contact whose mu_omega is not used: of the paper's cone, its number of rows.

    Raises
    ------
    StepDataError
        If a shape, a sign or a frame is wrong, or a number is not finite.
    """

    name: tuple[str, ...]
    phi: Array
    n: Array
    d1: Array
    d2: Array
    J: Array
    mu_v: Array
    mu_omega: Array
    rows: NDArray[np.int64]
    blocks: ClassVar[Blocks | None] = None

    def __post_init__(self) -> None:
        super().__post_init__()
        freeze(self, "J", (self.n_c, 4, columns(self.J, "contacts.J", 3)), "contacts")

    @property
    def n_v(self) -> int:
        """Number of columns of J."""
        return int(self.J.shape[-1])

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of each contact, shape (n_c, 4) [m, m, m, rad]."""
        return self.J @ delta_q

    def dense(self) -> Contacts:
        """Themselves; see :class:`SparseContacts`."""
        return self


@dataclass(frozen=True, eq=False)
class SparseContacts(Points):
    """The contact points of a step of many bodies: as :class:`Contacts`, J without its zeros.

    Parameters
    ----------
    name, phi, n, d1, d2, mu_v, mu_omega, rows
        As there.
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
    rows: NDArray[np.int64]

    def __post_init__(self) -> None:
        super().__post_init__()
        if len(self.blocks.J) != self.n_c:
            problem = f"must have {self.n_c} contacts"
            raise StepDataError(problem, field="contacts.blocks", value=len(self.blocks.J))

    @property
    def J(self) -> Array:
        """All of J, shape (n_c, 4, n_v): formed whenever it is asked for, and not kept."""
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
