"""The forces that pictures, tables and words show of a step, and which contacts bear load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from quasistatic_ref.errors import InputError

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Mask
    from quasistatic_ref.simulate.record.trajectory import Trajectory

BEARING: Final = 1e-3
"""A contact bears load above this share of the largest normal force [-]."""


def shown_forces(run: Trajectory, k: int) -> Array:
    """(f_d1, f_d2, f_n, tau_n) of each contact in step k, shape (n_c, 4) [N, N m].

    The forces of single contacts; what the multipliers combine to, where these are not known.
    """
    try:
        return run.step_forces(k)
    except InputError:
        return np.asarray(run["wrench"][k])


def bearing(f_n: Array) -> Mask:
    """Which contacts bear load, shape (n_c,), by their normal forces f_n, shape (n_c,) [N]."""
    return np.asarray(f_n > BEARING * f_n.max(initial=0.0))
