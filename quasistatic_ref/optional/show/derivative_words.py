"""Derivatives in words: which there are, how large they are, and why others are missing."""

from __future__ import annotations

from typing import Any

import numpy as np

from quasistatic_ref.optional.show.show import Page, counted, number
from quasistatic_ref.optional.show.step_words import ARRAY, array_rows

SHOWN = 3
"""Most reasons."""
DERIVATIVE = ("field", "columns", "largest", "reach", "kink")


def sensitivity_page(found: Any) -> Page:
    """Derivatives of delta_q by each parameter of a step."""
    arrays = {name: array for name, array in vars(found).items() if name != "why_not"}
    facts = [f"no {name}: {reason}" for name, reason in found.why_not.items()]
    title = f"Sensitivity: {counted(len(found.h), 'coordinate')}, d delta_q by each parameter"
    return title, facts[:SHOWN], ARRAY, array_rows(arrays)


def derivatives_page(found: Any) -> Page:
    """Derivatives, of the part of that name: what there is, how far it holds, and why not."""
    title = f"Derivatives: {'' if found.differentiable else 'not '}differentiable, reach "
    rows = []
    for name, kinks in found.reaches.items():
        least = min(kinks, key=lambda one: one.distance, default=None)
        if least is not None:
            largest = float(np.abs(getattr(found, name)).max())
            rows.append(
                (name, str(len(kinks)), number(largest), number(least.distance), least.where)
            )
    says = [why.sentence for why in found.reasons[:SHOWN]]
    return f"{title}{number(found.reach)}", says, DERIVATIVE, rows
