r"""Rows that a small change brings to touch, or relieves of their load, to first order: (R41).

A small change of a parameter changes the slack of an open row by ds, and what the rows exert by dv.
A row whose slack is less than ds is nearly at a kink. So is one that in every optimal lam has less
than dv: as much, at most, is taken from it.
"""

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.optional.derivatives.step.optimum_rates import (
    DataRates,
    Equations,
    OptimumRates,
)
from quasistatic_ref.optional.derivatives.step.touching import BEARING, bearing, unit_rows


def nearly_weak(
    equations: Equations, rates: OptimumRates, data: DataRates, changes: Array
) -> Indices:
    """Contact and row of those that nearly touch, or nearly bear no load, shape (k, 2).

    Parameters
    ----------
    equations : Equations
        What the optimum keeps.
    rates : OptimumRates
        Of the optimum.
    data : DataRates
        Of the step.
    changes : ndarray, shape (P,)
        How small a change of each parameter is [each in its parameter's unit].
    """
    t = equations.of
    closing, _ = equations.slack_rates(t.open, rates.x, data)
    closes = t.slack[:, None] < np.abs(closing) * changes
    dv = float((np.linalg.norm(rates.exerted, axis=0) * changes).max(initial=0.0))
    unit, length = unit_rows(t.rows(t.strict) @ t.inverse.T)
    loads = t.impulses[tuple(t.strict.T)] * length
    eased = ~bearing(unit, loads, dv / BEARING) if dv else np.zeros(len(unit), dtype=bool)
    return np.concatenate([t.open[closes.any(axis=1)], t.strict[eased]])
