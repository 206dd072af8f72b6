"""Every field of a study file, said once: the loader, a JSON Schema and a page read this table.

What goes beyond one field, such as that a solver is installed, the loader checks by hand.
"""

from typing import Any

from quasistatic_ref.formats.declared import Field, Tables
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.json_schema import json_schema
from quasistatic_ref.lab.study.problems.dials import DIALS, SCENARIOS
from quasistatic_ref.lab.study.problems.names import UNITS
from quasistatic_ref.lab.study.solvers import DOORS, SETTINGS
from quasistatic_ref.tolerances import LARGE

FORMAT = "quasistatic-ref/study"
VERSION = 2
COLD, WARM = STARTS = ("cold", "warm")
MOST_PROBLEMS = 100_000
LONGEST_LIMIT = 1e6
"""Of one problem [s]."""
STUDY = "a study"
PROBLEMS = "[problems]"
COUNTS = "[problems.families]"
COUNT = "[problems.families.NAME]"
SETTING = "[settings.NAME]"
SOLVER = "[solvers.NAME]"
RUN = "[[runs]]"


def _family(says: str) -> Field:
    number = {"type": "integer", "minimum": 0, "maximum": MOST_PROBLEMS}
    inner = {"$ref": "#/definitions/problems_families_NAME"}
    return Field("integer or table", says, default=0, of=COUNT,
                 schema={"anyOf": [number, inner]})  # fmt: skip


class WholeTables(Tables):
    """Fields by name, by the kind of table, each of which is read as a whole."""

    def all_values(self, table: TableReader, kind: str) -> dict[str, Any]:
        """Every field of a table of some kind, by name.

        Raises
        ------
        InputError
            If the table has any other, or one is not of its kind.
        """
        table.only(self[kind])
        return {name: self.value(table, kind, name) for name in self[kind]}


TABLES = WholeTables({
    STUDY: {
        "format": Field("text", "what the file is", choices=(FORMAT,)),
        "version": Field("integer", "of the format", choices=(VERSION,)),
        "time_limit": Field("number", "of one call; a solver that takes longer is ended", "s", 2.0,
                            above=0.0, most=LONGEST_LIMIT),
        "warm_up": Field("number", "of the first call of a shape at a setting, in which a solver "
                         "may compile; not counted", "s", 10.0, above=0.0, most=LONGEST_LIMIT),
        "budget": Field("number", "of one solver, all its calls together, each time that the study "
                        "runs", "s", 600.0, above=0.0, most=LARGE),
        "memory": Field("number", "of one solver's process", "GB", 4.0, above=0.0, most=LARGE),
        "repetitions": Field("integer", "calls that are timed, of each measurement", default=5,
                             least=1, most=1000),
        "problems": Field("table", "on what solvers are compared", default={}, of=PROBLEMS),
        "settings": Field("tables by name", default={}, of=SETTING, says="settings of your own, "
                          f"or others in place of {', '.join(s.name for s in SETTINGS)}"),
        "solvers": Field("tables by name", "functions, and solvers with options of your own",
                         default={}, of=SOLVER),
        "runs": Field("list of tables", "solvers, and in which way", default=[{}], least=1, of=RUN),
    },
    PROBLEMS: {
        "set": Field("text", "what problems are taken from, \"contact-qp\" or the folder of "
                     "another set; else they are steps of scenarios", default=None),
        "scenarios": Field("list of words", "whose steps problems are made of: names, or files in "
                           "the study's folder; else all that come along", default=None),
        "families": Field("table", "how many problems of each", default={SCENARIOS: 20},
                          of=COUNTS),
    },
    COUNTS: {
        SCENARIOS: _family("steps of the scenarios"),
        **{name: _family("of a set; dial: {name}, {first:g} to {most:g} {unit}".format(**dial))
           for name, dial in DIALS.items()},
    },
    COUNT: {
        "count": Field("integer", "how many problems", least=0, most=MOST_PROBLEMS),
        "most": Field("number", "where the dial ends; else at its hard end", default=None,
                      above=0.0, most=LARGE),
    },
    SETTING: {
        "accuracy": Field("number", "of residuals and gap; a new name needs it", "-", None,
                          above=0.0, most=LARGE),
        "tuned": Field("boolean", "whether with the options that the simulator uses; false for a "
                       "new name", default=None),
    },
    SOLVER: {
        "qpsolvers": Field("text", "a solver's name, for options of its own without CVXPY",
                           default=None),
        "cvxpy": Field("text", "a solver's name, for options of its own through CVXPY",
                       default=None),
        "function": Field("text", "FILE.py:FUNCTION or MODULE:FUNCTION", default=None,
                          schema={"pattern": r"^.+:[A-Za-z_]\w*$"}),
        "options": Field("tables by name", "options at each setting, in place of ours",
                         default={}),
        "promised": Field("tables by name", "what \"optimal\" promises of residuals at each "
                          "setting: primal, dual, gap, each a number or a table of abs, rel, of",
                          default={}),
    },
    RUN: {
        "solvers": Field("list of words", "qpsolvers:NAME, cvxpy:NAME, * for every one that is "
                         "installed, or names of [solvers.NAME]", default=["qpsolvers:*"], least=1),
        "settings": Field("list of words", "names of settings", default=["default"], least=1),
        "units": Field("list of words", f"of {', '.join(UNITS)}", default=["natural"], least=1,
                       schema={"items": {"enum": list(UNITS)}}),
        "starts": Field("list of words", "cold; warm: from the solver's answer to the step before "
                        "in a sequence, else to a neighbour", default=[COLD], least=1,
                        schema={"items": {"enum": list(STARTS)}}),
        "every": Field("integer", "take the first problem of every so many", default=1, least=1,
                       most=MOST_PROBLEMS),
    },
})  # fmt: skip
"""The fields of each kind of table, in the order of the reference page."""


def study_schema() -> dict[str, Any]:
    """The JSON Schema of a study file."""
    rules = {SOLVER: {"oneOf": [{"required": [door]} for door in DOORS]}}
    return json_schema("A study", TABLES, rules, STUDY)
