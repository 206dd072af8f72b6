"""Derivatives in words: which there are, how large they are, and why others are missing."""

from __future__ import annotations

from typing import Any

import numpy as np

from quasistatic_ref.optional.show.show import Page, number

SHOWN = 3
"""Most reasons."""
DERIVATIVE = ("field", "columns", "largest", "reach", "kink")


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
