"""The canonical text of a step, one line of JSON, and the hash that identifies the step.

Numbers are written in shortest round-trip decimal, so a step read back is the same bits.
"""

import hashlib
from dataclasses import asdict
from typing import Any

from quasistatic_ref.step.data import StepData
from quasistatic_ref.text.json_text import json_text

STEP_FORMAT = "quasistatic-ref/step"
VERSION = 1
NUMBERS = ("h", "n_a", "n_u", "K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a")
CONTACT = ("name", "phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows")


def step_record(step: StepData) -> dict[str, Any]:
    """The step as a JSON object."""
    columns = {key: getattr(step.contacts, key) for key in CONTACT}
    record: dict[str, Any] = {"format": STEP_FORMAT, "version": VERSION, "cone": step.cone}
    record |= {key: getattr(step, key) for key in NUMBERS}
    record["contacts"] = [
        {key: column[j] for key, column in columns.items()} for j in range(step.contacts.n_c)
    ]
    if not step.extra.empty:
        record["extra"] = {k: v for k, v in asdict(step.extra).items() if v is not None}
    return record


def step_text(step: StepData) -> str:
    """The step as one line of JSON."""
    return json_text(step_record(step)) + "\n"


def step_sha256(step: StepData) -> str:
    """SHA-256 of :func:`step_text`, which identifies the step by its bits."""
    return hashlib.sha256(step_text(step).encode()).hexdigest()
