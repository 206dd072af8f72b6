"""Findings as tables, as headers of trajectories and reports in JSON hold them."""

from collections.abc import Mapping
from typing import Any

from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.text.declared import Field, Tables

FINDING = "findings"
TABLES = Tables({
    FINDING: {
        "name": Field("text", "of its kind"),
        "grave": Field("boolean", "whether the run is not what was meant"),
        "sentence": Field("text", "the cause, then the remedy"),
        "remedy": Field("text", "what to do"),
        "numbers": Field("numbers by name", "what was measured, by names that end in the unit"),
        "of": Field("text", "what it is about", default=""),
    },
})  # fmt: skip


def finding_table(finding: Finding) -> dict[str, Any]:
    """A finding as the table that files hold."""
    return TABLES.record(FINDING, finding)


def finding_read(table: Mapping[str, Any]) -> Finding:
    """A finding from the fields of its table.

    In older files the remedy comes first in its sentence, and nothing says what it is about.
    """
    values = {**table}
    remedy, sentence = values["remedy"], values.pop("sentence")
    return Finding(cause=sentence.removeprefix(f"{remedy}: ").removesuffix(f"; {remedy}"), **values)
