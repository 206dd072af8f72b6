"""What of an extension is numbers already: its rows and private rises, as data of a step."""

import numpy as np

from quasistatic_ref.optional.extensions.extension import Extension
from quasistatic_ref.optional.extensions.rises import with_rises
from quasistatic_ref.step.data import Extra, StepData


def with_numbers(step: StepData, extension: Extension) -> StepData:
    """A step with an extension's rows and private rises, which are numbers already."""
    rows = extension.rows
    if rows is not None:
        extra = joined(step.extra, rows)
        if rows.cost is not None or extra.A.shape[1] != step.n_v:
            step = step.replace(extra=extra)  # which has to fit
        else:
            step = step.with_fields(extra=extra)
    return with_rises(step, extension.rises)


def joined(first: Extra, second: Extra) -> Extra:
    """Two sets of own rows and costs as one: rows one after the other, costs added."""
    if first.empty:
        return second
    names = first.names + second.names
    A = np.vstack([first.A, second.A])
    b = np.concatenate([first.b, second.b])
    costs = [one.cost for one in (first, second) if one.cost is not None]
    if not costs:
        return Extra(names, A, b)
    H = np.sum([H for H, _ in costs], axis=0)
    g = np.sum([g for _, g in costs], axis=0)
    return Extra(names, A, b, H, g)
