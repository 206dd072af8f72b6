"""Every field of a scenario as the page on scenarios lists them."""

from quasistatic_ref.fields import REQUIRED
from quasistatic_ref.files import json_text
from quasistatic_ref.simulate.scenario_table import TABLES, Field


def reference_page() -> str:
    """Every field as Markdown, one table for each kind of table."""
    parts = []
    for kind, fields in TABLES.items():
        rows = ["| field | value | unit | default | says |", "|---|---|---|---|---|"]
        for name, one in fields.items():
            cells = (f"`{name}`", _values(one), one.unit, _default(one), one.says)
            rows.append(f"| {' | '.join(cells)} |")
        parts.append("\n".join([f"## {_heading(kind)}", "", *rows]))
    return "\n\n".join(parts) + "\n"


def _heading(kind: str) -> str:
    return f"`{kind}`" if kind[0] == "[" else kind[0].upper() + kind[1:]


def _values(one: Field) -> str:
    """What a field may hold, in words."""
    if one.choices is not None:
        return ", ".join(f"`{json_text(choice)}`" for choice in one.choices)
    bounds = [(one.above, "above"), (one.least, "from"), (one.most, "to")]
    said = " ".join(f"{word} {bound:g}" for bound, word in bounds if bound is not None)
    return f"{one.kind}{', ' if said else ''}{said}"


def _default(one: Field) -> str:
    if one.default is REQUIRED:
        return "required"
    return "" if one.default is None else f"`{json_text(one.default)}`"
