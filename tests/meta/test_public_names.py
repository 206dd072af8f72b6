"""What users write is frozen: names with their parameters, formats, fields of files and commands.

A change stands in the changelog, old and new, and in the list, which ``python -m
tests.meta.test_public_names`` writes again.
"""

import inspect
from operator import attrgetter

import quasistatic_ref as qr
from quasistatic_ref.cli import main
from quasistatic_ref.files.scenario.scenario_table import TABLES
from quasistatic_ref.lab.commands.schema import SCHEMAS
from quasistatic_ref.lab.vectors import versions
from tests.meta.remedies import assert_alike
from tests.pages import ROOT

LIST = ROOT / "tests" / "public_names.txt"


def frozen_lines():
    """A line for each name, format, table of a file, and command with its options."""
    of_figures = {f"figures.{name}" for name in qr.figures.__all__}
    for name in sorted({*qr.__all__, *of_figures} - {"__version__", "figures"}):
        try:
            parameters = inspect.signature(attrgetter(name)(qr)).parameters
        except ValueError:  # an error that is given a sentence
            parameters = ()
        yield f"qr.{name}({', '.join(parameters)})"
    for kind in ("step", "solution", "scenario", "header"):
        stated = SCHEMAS[kind]()["properties"]
        yield " ".join(str(*stated[name]["enum"]) for name in ("format", "version"))
    yield f"{versions.FORMAT} {versions.FORMAT_VERSION}"
    for table, own in TABLES.items():
        yield f"scenario, {table}: {' '.join(sorted(own))}"
    for leaf in sorted(
        main._actions(main.command_parser(main.COMMANDS)), key=lambda leaf: leaf.prog
    ):
        options = (word for action in leaf._actions for word in action.option_strings)
        yield " ".join([leaf.prog, *sorted(options)])


def test_public_names_are_those_of_the_list():
    command = "run `python -m tests.meta.test_public_names`, and name old and new in CHANGELOG.md"
    assert_alike(
        frozen_lines(),
        LIST.read_text("utf-8").splitlines(),
        f"{{}}: not in tests/public_names.txt; {command}",
        f"{{}}: in tests/public_names.txt, and no more; {command}",
    )


if __name__ == "__main__":
    LIST.write_text("\n".join(frozen_lines()) + "\n", "utf-8")
