"""The contact points of one step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import StepDataError
from quasistatic_ref.step.arrays import columns, freeze, names, numbers, read_only
from quasistatic_ref.step.blocks import Blocks
from quasistatic_ref.step.lazy import Lazy
from quasistatic_ref.step.show import shown
from quasistatic_ref.step.words import contacts_page
from quasistatic_ref.tolerances import ORTHONORMAL

Array = NDArray[np.float64]
ROWS = (4, 6)


@dataclass(frozen=True, eq=False)
class Contacts(Lazy):
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

    Attributes
    ----------
    blocks : Blocks or None
        In steps of many bodies, J without its zeros; J is then formed when somebody asks for it.

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

    __repr__, _repr_html_ = shown(contacts_page)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", names(self.name, "contacts.name"))
        n_c = len(self.name)
        n_v = columns(self.J, "contacts.J", 3)
        shapes = {"phi": (n_c,), "n": (n_c, 3), "d1": (n_c, 3), "d2": (n_c, 3)}
        shapes |= {"J": (n_c, 4, n_v), "mu_v": (n_c,), "mu_omega": (n_c,)}
        for key, shape in shapes.items():
            freeze(self, key, shape, "contacts")
        rows = numbers(self.rows, "contacts.rows")
        if rows.shape != (n_c,) or not np.isin(rows, ROWS).all():
            problem = "must be 4 or 6 for each contact"
            raise StepDataError(problem, field="contacts.rows", value=rows.tolist())
        object.__setattr__(self, "rows", read_only(rows.astype(np.int64)))
        for key in ("mu_v", "mu_omega"):
            bad = np.flatnonzero(getattr(self, key) < 0)
            if bad.size:
                at, value = self.name[bad[0]], float(getattr(self, key)[bad[0]])
                raise StepDataError("must be >= 0", field=f"contacts[{at}].{key}", value=value)
        frame = np.stack([self.d1, self.d2, self.n], axis=2)
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is no unit vector
            product = np.swapaxes(frame, 1, 2) @ frame
            defect = np.abs(product - np.eye(3)).max(axis=(1, 2), initial=0)
            dextral = np.einsum("ci,ci->c", np.cross(self.d1, self.d2), self.n) > 0
        bad = np.flatnonzero(~(defect <= ORTHONORMAL) | ~dextral)
        if bad.size:
            raise StepDataError(
                "d1, d2, n must be a right-handed orthonormal frame",
                field=f"contacts[{self.name[bad[0]]}]",
                value=frame[bad[0]].T.tolist(),
            )

    @property
    def n_c(self) -> int:
        """Number of contacts."""
        return len(self.phi)

    @cached_property
    def mu(self) -> Array:
        """(mu_v, mu_v, mu_omega) of each contact, shape (n_c, 3), 0 where it is not used."""
        mu_omega = np.where(self.rows == 6, self.mu_omega, 0.0)
        return read_only(np.stack([self.mu_v, self.mu_v, mu_omega], axis=1))

    @property
    def n_v(self) -> int:
        """Number of columns of J."""
        return int(self.J.shape[-1]) if self.blocks is None else self.blocks.n_v

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of each contact, shape (n_c, 4) [m, m, m, rad]."""
        return self.J @ delta_q if self.blocks is None else self.blocks.motion(delta_q)

    def moved(
        self,
        name: Callable[[], tuple[str, ...]],
        *,
        blocks: Blocks | None = None,
        **geometry: Array,
    ) -> Contacts:
        """The same contacts elsewhere: `geometry` anew, unchecked.

        With blocks in place of J, J is formed from them when somebody asks for it.

        For steps in sequence: what does not depend on where they are is not made again, and
        their names are not made before somebody asks for them.

        Parameters
        ----------
        name : callable
            The names of the contacts.
        blocks : Blocks, optional
        geometry : ndarray
            phi of shape (n_c,) [m], and n, d1, d2 and J in the shapes of the class.
        """
        other = object.__new__(Contacts)
        other.__dict__.update(self.__dict__, **geometry, later={"name": name})
        other.__dict__.pop("name", None)
        other.__dict__.pop("blocks", None)
        if blocks is not None:
            other.__dict__.pop("J", None)
            other.__dict__["blocks"], other.__dict__["later"]["J"] = blocks, blocks.dense
        return other
