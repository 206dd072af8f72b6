"""Derivatives in words: which there are, how large they are, and why others are missing."""

from __future__ import annotations

from typing import Any

from quasistatic_ref.optional.show.show import Page, counted
from quasistatic_ref.optional.show.step_words import ARRAY, array_rows

SHOWN = 3
"""Most reasons."""


def sensitivity_page(found: Any) -> Page:
    """Derivatives of delta_q by each parameter of a step."""
    arrays = {name: array for name, array in vars(found).items() if name != "why_not"}
    facts = [f"no {name}: {reason}" for name, reason in found.why_not.items()]
    title = f"Sensitivity: {counted(len(found.h), 'coordinate')}, d delta_q by each parameter"
    return title, facts[:SHOWN], ARRAY, array_rows(arrays)


def derivatives_page(found: Any) -> Page:
    """Derivatives of the configuration after a step."""
    arrays = {name: array for name, array in vars(found).items() if name.startswith("dq_d")}
    verdict = "" if found.differentiable else "not "
    title = f"Derivatives: {counted(len(found.dq_dh), 'coordinate')}, {verdict}differentiable"
    return title, list(map(str, found.reasons[:SHOWN])), ARRAY, array_rows(arrays)
