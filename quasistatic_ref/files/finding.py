"""Findings as tables, as headers of trajectories and reports in JSON hold them."""

from typing import Any

from quasistatic_ref.files.table_reader import TableReader
from quasistatic_ref.simulate.finding import Finding


def finding_table(finding: Finding) -> dict[str, Any]:
    """A finding as the table that files hold.

    Its fields are ``name``, ``grave``, ``sentence``, ``remedy``, ``numbers`` and ``of``.

    Parameters
    ----------
    finding : Finding
    """
    return {
        "name": finding.name,
        "grave": finding.grave,
        "sentence": finding.sentence,
        "remedy": finding.remedy,
        "numbers": dict(finding.numbers),
        "of": finding.of,
    }


def finding_read(table: object, where: str) -> Finding:
    """A finding as it stands in the header of a trajectory.

    In older files the remedy comes first in its sentence, and nothing says what it is about.

    Raises
    ------
    InputError
        If a field is missing, unknown or of another type.
    """
    fields = TableReader(table, where)
    numbers = fields.table("numbers")
    remedy = fields.text("remedy")
    finding = Finding(
        name=fields.text("name"),
        grave=fields.boolean("grave"),
        remedy=remedy,
        cause=fields.text("sentence").removeprefix(f"{remedy}: ").removesuffix(f"; {remedy}"),
        numbers={name: numbers.number(name) for name in numbers.names_left()},
        of=fields.text("of", ""),
    )
    fields.close()
    return finding
