"""The forces that pictures, tables and words show of a step, and which contacts bear load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from quasistatic_ref.errors import InputError

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Mask
    from quasistatic_ref.simulate.record.trajectory import Trajectory

BEARING: Final = 1e-3
"""A contact bears load above this share of the largest normal force [-]."""
ENTRIES: Final = {"f_d1": "N", "f_d2": "N", "f_n": "N", "tau_n": "N m"}
"""Names and units of a wrench."""


class ShownForces(NamedTuple):
    """What is shown of the contacts of one step.

    Parameters
    ----------
    wrench : ndarray, shape (n_c, 4)
        (f_d1, f_d2, f_n, tau_n) [N, N m].
    known : bool
        Whether they are the forces of single contacts; else what lam combines to, which is one of
        several wrenches where multipliers are not unique.
    """

    wrench: Array
    known: bool

    @property
    def columns(self) -> tuple[str, ...]:
        """Names and units of the four entries."""
        of = "" if self.known else " of lam"
        return tuple(f"{name}{of} [{unit}]" for name, unit in ENTRIES.items())

    @property
    def newton(self) -> str:
        """The unit of what is drawn."""
        return "1 N" if self.known else "1 N of lam"


def shown_forces(run: Trajectory, k: int) -> ShownForces:
    """The forces of single contacts in step k; what lam combines to, where these are not known."""
    try:
        return ShownForces(run.step_forces(k), known=True)
    except InputError:
        return ShownForces(np.asarray(run["wrench"][k]), known=False)


def bearing(f_n: Array) -> Mask:
    """Which contacts bear load, shape (n_c,), by their normal forces f_n, shape (n_c,) [N]."""
    return np.asarray(f_n > BEARING * f_n.max(initial=0.0))
