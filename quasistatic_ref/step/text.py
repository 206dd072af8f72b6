"""Step files, ``quasistatic-ref/step``: their fields, their text, and the hash of a step.

Numbers are written in shortest round-trip decimal, so a step read back is the same bits.
"""

import hashlib
from dataclasses import asdict
from typing import Any

from quasistatic_ref.step.cones import PYRAMID
from quasistatic_ref.step.data import StepData
from quasistatic_ref.text.declared import Field, Tables, head
from quasistatic_ref.text.json_text import json_text

STEP_FORMAT = "quasistatic-ref/step"
VERSION = 1
TOP = "a step"
CONTACT = "contacts"
EXTRA = "extra"
VELOCITIES = "n_a + n_u"
"""n_v, the entries of delta_q."""

TABLES = Tables({
    TOP: {
        **head(STEP_FORMAT, VERSION),
        "cone": Field("text", "friction cone of its contacts", default=PYRAMID),
        "h": Field("number", "time step", "s", above=0.0),
        "n_a": Field("integer", "number of actuated coordinates", least=0),
        "n_u": Field("integer", "number of un-actuated coordinates; n_v = n_a + n_u", least=0),
        "K_q": Field("numbers", "stiffness", "N/m, N m/rad", shape=("n_a", "n_a")),
        "M_u": Field("numbers", "mass matrix", "kg, kg m, kg m^2", shape=("n_u", "n_u")),
        "tau_a": Field("numbers", "forces on actuated coordinates", "N, N m", shape=("n_a",)),
        "tau_u": Field("numbers", "forces on un-actuated coordinates", "N, N m", shape=("n_u",)),
        "delta_q_bar_a": Field("numbers", "displacement to the target", "m, rad", shape=("n_a",)),
        "contacts": Field("list of tables", "each contact", of=CONTACT),
        "extra": Field(
            "table", "only where the user has added rows A delta_q >= b or a cost "
            "1/2 x'Hx - g'x of x = delta_q",
            default={"names": [], "A": [], "b": []}, of=EXTRA,
        ),
    },
    CONTACT: {
        "name": Field("text", "of the pair, and a number"),
        "phi": Field("number", "gap", "m"),
        "n": Field("three numbers", "normal, from alpha to beta, along the world's axes"),
        "d1": Field("three numbers", "first tangent"),
        "d2": Field("three numbers", "second tangent; n, d1, d2 are right-handed"),
        "J": Field(
            "numbers", "motion of beta's point against alpha's along the world's x, y and z, and "
            "spin about n, per unit of delta_q", "m, rad", shape=(4, VELOCITIES),
        ),
        "mu_v": Field("number", "friction", "-", least=0.0),
        "mu_omega": Field("number", "torsional friction", "m", least=0.0),
        "rows": Field("integer", "6, or 4 without torsional friction", choices=(4, 6)),
    },
    EXTRA: {
        "names": Field("list of words", "of the rows"),
        "A": Field("numbers", "the rows", shape=("names", VELOCITIES)),
        "b": Field("numbers", "their right sides", shape=("names",)),
        "H": Field("numbers", "of the cost", default=None, shape=(VELOCITIES, VELOCITIES)),
        "g": Field("numbers", "of the cost", default=None, shape=(VELOCITIES,)),
    },
})  # fmt: skip
"""Every field of a step's file, in its order: the reader, the writer and the JSON Schema use it."""


def step_record(step: StepData) -> dict[str, Any]:
    """The step as a JSON object."""
    columns = {key: getattr(step.contacts, key) for key in TABLES[CONTACT]}
    record = TABLES.record(TOP, step)
    record["contacts"] = [
        {key: column[j] for key, column in columns.items()} for j in range(step.contacts.n_c)
    ]
    extra = record.pop("extra")
    if not extra.empty:
        record["extra"] = {k: v for k, v in asdict(extra).items() if v is not None}
    return record


def step_text(step: StepData) -> str:
    """The step as one line of JSON."""
    return json_text(step_record(step)) + "\n"


def step_sha256(step: StepData) -> str:
    """SHA-256 of :func:`step_text`, which identifies the step by its bits."""
    return hashlib.sha256(step_text(step).encode()).hexdigest()
