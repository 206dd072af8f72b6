"""The fields and arrays of files, and the options of commands, as pages about them list them."""

import argparse
from collections.abc import Iterable

from quasistatic_ref.lab.markdown import markdown_table
from quasistatic_ref.simulate.record.table import ARRAYS
from quasistatic_ref.text.declared import Field, Tables
from quasistatic_ref.text.json_text import json_text
from quasistatic_ref.text.table_reader import REQUIRED


def reference_page(tables: Tables) -> str:
    """Every field of a file as Markdown, one table for each kind of table."""
    parts = []
    for kind, fields in tables.items():
        rows = [
            (f"`{name}`", _values(one), one.unit, _default(one), one.says)
            for name, one in fields.items()
        ]
        table = markdown_table(("field", "value", "unit", "default", "says"), rows)
        parts.append("\n".join([f"### {_heading(kind)}", "", *table]))
    return "\n\n".join(parts) + "\n"


def arrays_page() -> str:
    """Every array of a trajectory as a table in Markdown."""
    rows = [
        (f"`{name}`", kept.shape.replace(" ", " x "), kept.of, kept.says)
        for name, kept in ARRAYS.items()
    ]
    return "\n".join(markdown_table(("array", "shape", "records", "holds"), rows)) + "\n"


def options_page(commands: Iterable[argparse.ArgumentParser]) -> str:
    """Every option of each command, as ``--help`` has it, as a table in Markdown."""
    rows = []
    for command in commands:
        name = f"`{command.prog.partition(' ')[2]}`"
        for action in command._actions:
            if "--help" not in action.option_strings and action.option_strings:
                words = ", ".join(f"`{word}`" for word in action.option_strings)
                says = str(action.help).replace("%%", "%").replace("|", "\\|")
                rows.append((name, words, says))
                name = ""
    return "\n".join(markdown_table(("command", "option", "says"), rows)) + "\n"


def _heading(kind: str) -> str:
    return f"`{kind}`" if kind[0] == "[" else kind[0].upper() + kind[1:]


def _values(one: Field) -> str:
    """What a field may hold, in words."""
    if one.choices is not None:
        return ", ".join(f"`{json_text(choice)}`" for choice in one.choices)
    if one.kind == "numbers":
        return "numbers, " + " x ".join(f"({n})" if " " in str(n) else str(n) for n in one.shape)
    if one.kind.startswith("list of "):
        return f"{one.kind}{', not empty' if one.least else ''}"
    bounds = [(one.above, "above"), (one.least, "from"), (one.most, "to")]
    said = " ".join(f"{word} {bound:.10g}" for bound, word in bounds if bound is not None)
    return f"{one.kind}{', ' if said else ''}{said}{' or null' if one.null else ''}"


def _default(one: Field) -> str:
    if one.default is REQUIRED:
        return "required"
    return "" if one.default is None else f"`{json_text(one.default)}`"
