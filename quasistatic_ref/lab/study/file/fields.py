"""Every field of a study file, said once: the loader, a JSON Schema and a page read this table.

What goes beyond one field, such as that a solver is installed, the loader checks by hand.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from quasistatic_ref.formats.declared import Field, Tables
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.json_schema import json_schema
from quasistatic_ref.lab.study.calling.sessions import MODES
from quasistatic_ref.lab.study.calling.solvers import INTERFACES, SETTINGS
from quasistatic_ref.lab.study.problems.dials import DIALS
from quasistatic_ref.lab.study.problems.names import UNITS
from quasistatic_ref.tolerances import LARGE

FORMAT = "quasistatic-ref/study"
VERSION = 1
MOST_PROBLEMS = 100_000
LONGEST_LIMIT = 1e6
"""Of one problem [s]: an operating system waits for 2^31 ms, of which a warm call takes half."""
MODULE = r"^[A-Za-z_][A-Za-z_0-9.]*:[A-Za-z_][A-Za-z_0-9]*$"
STUDY = "a study"
SOLVERS = "a study of solvers"
SWEEPS = "a study of sweeps"
PROBLEMS = "[problems]"
COUNTS = "[problems.families]"
COUNT = "[problems.families.NAME]"
SETTING = "[settings.NAME]"
SOLVER = "[solvers.NAME]"
RUN = "[[runs]]"
SWEEP = "[[sweeps]]"
AXIS = "[sweeps.axes.NAME]"
TEXT = {"type": "string"}


def _head(kind: str, **default: Any) -> dict[str, Field]:
    return {
        "format": Field("text", "what the file is", choices=(FORMAT,)),
        "version": Field("integer", "of the format", choices=(VERSION,)),
        "kind": Field("text", "what is studied", choices=(kind,), **default),
    }


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
    SOLVERS: {
        **_head("solvers", default="solvers"),
        "time_limit": Field("number", "of one problem; a solver that takes longer is killed", "s",
                            2.0, above=0.0, most=LONGEST_LIMIT),
        "budget": Field("number", "of one solver, all its calls together", "s", 600.0, above=0.0,
                        most=LARGE),
        "warm_up": Field("number", "of the first call of a shape at a setting, in which a solver "
                         "may compile; not counted", "s", 10.0, above=0.0, most=LONGEST_LIMIT),
        "memory": Field("number", "of one solver's processes", "GB", 4.0, above=0.0, most=LARGE),
        "repetitions": Field("integer", "calls whose times are taken, of each measurement; more "
                             "where they are short", default=5, least=1, most=1000),
        "problems": Field("table", "on what solvers are compared", default={}, of=PROBLEMS),
        "settings": Field("tables by name", default={}, of=SETTING, says="settings of your own, "
                          f"or others in place of {', '.join(s.name for s in SETTINGS)}"),
        "solvers": Field("tables by name", "solvers that are not listed, or have options of their "
                         "own", default={}, of=SOLVER),
        "runs": Field("list of tables", "solvers, and in which way", default=[{}], least=1, of=RUN),
    },
    PROBLEMS: {
        "seed": Field("integer", "the order in which problems are run is a function of it",
                      default=1, least=0, most=2**32 - 1),
        "scenarios": Field("list of words", "whose steps problems are made of: names, or files in "
                           "the study's folder; else all that come along", default=None),
        "set": Field("text", "what problems are taken from, \"contact-qp-2\", \"contact-qp-1\" "
                     "or the folder of another set; else they are steps of scenarios",
                     default=None),
        "families": Field("table", "how many problems of each", default={"scenarios": 20},
                          of=COUNTS),
    },
    COUNTS: {
        "scenarios": _family("steps of the scenarios"),
        **{name: _family("of a set; dial: {name}, {first:g} to {most:g} {unit}".format(**own))
           for name, own in DIALS.items()},
    },
    COUNT: {
        "count": Field("integer", "how many problems", least=0, most=MOST_PROBLEMS),
        "most": Field("number", "where the dial ends; else at its hard end", default=None,
                      above=0.0, most=LARGE),
    },
    SETTING: {
        "accuracy": Field("number", "of residuals and gap; a new name needs it", "-", None,
                          above=0.0, most=LARGE),
        "promised": Field("number", "digits that \"optimal\" promises; else those of each solver's "
                          "tolerances", "-", None, least=0.0, most=LARGE),
        "tuned": Field("boolean", "whether with the options that the simulator uses; false for a "
                       "new name", default=None),
    },
    SOLVER: {
        "cvxpy": Field("text", "a solver's name, for options of its own through CVXPY",
                       default=None),
        "qpsolvers": Field("text", "a solver's name, for options of its own without CVXPY",
                           default=None),
        "native": Field("text", "a solver's name, for options of its own in its own interface",
                        default=None),
        "package": Field("text", "a solver that an installed package announces, for options of its "
                         "own", default=None),
        "callable": Field("text", "module:function", default=None, schema={"pattern": MODULE}),
        "executable": Field("list of words", "a program and its arguments", default=None, least=1),
        "options": Field("tables by name", "options at each setting, in place of ours",
                         default={}),
    },
    RUN: {
        "solvers": Field("list of words", "qpsolvers:NAME, cvxpy:NAME, native:NAME, package:NAME, "
                         "* for every one that is installed, or names of [solvers.NAME]",
                         default=["qpsolvers:*"], least=1),
        "settings": Field("list of words", "names of settings", default=["default"], least=1),
        "units": Field("list of words", f"of {', '.join(UNITS)}", default=["natural"], least=1,
                       schema={"items": {"enum": list(UNITS)}}),
        "warm": Field("list of true and false", "whether from the answer to a neighbour",
                      default=[False], least=1,
                      schema={"type": "array", "items": {"type": "boolean"}}),
        "every": Field("integer", "take the first problem of every so many", default=1, least=1,
                       most=MOST_PROBLEMS),
        "again": Field("integer", "run one of so many of these problems again, after all "
                       "others, which measures the noise; 0: none", default=10, least=0,
                       most=MOST_PROBLEMS),
        "modes": Field("list of words", "solve sequences of steps in order, with what a solver "
                       f"keeps of the step before: {', '.join(MODES)}; else each problem is solved "
                       "alone", default=[], schema={"items": {"enum": list(MODES)}}),
    },
    SWEEPS: {
        **_head("sweep"),
        "sweeps": Field("list of tables", "which scenarios, with which values", least=1, of=SWEEP),
    },
    SWEEP: {
        "name": Field("text", "of the sweep; else the scenario's", default=None),
        "scenario": Field("text", "a name, or a file in the study's folder"),
        "link": Field("text", "whose motion is measured"),
        "duration": Field("number", "of each run, whatever h is; else the scenario's steps", "s",
                          None, above=0.0, most=LARGE),
        "since": Field("number", "from when on rotation and travel count", "s", 0.0, least=0.0,
                       most=LARGE),
        "axes": Field("tables by name", "parameters; each combination of their values is a run",
                      of=AXIS, schema={"minProperties": 1}),
    },
    AXIS: {
        "fields": Field("list of words", "dotted fields of the scenario that are set to each value;"
                        " else the axis's name", default=None, least=1),
        "values": Field("list of numbers and words", "one after the other", least=1,
                        schema={"type": "array", "items": {"anyOf": [
                            TEXT, {"type": "number", "minimum": -LARGE, "maximum": LARGE}]}}),
    },
})  # fmt: skip
"""The fields of each kind of table, in the order of the reference page."""


def study_schema() -> dict[str, Any]:
    """The JSON Schema of a study file, of either kind.

    One table has the fields of both kinds: an editor then marks the field that is wrong, and not
    the whole file.
    """
    inner = {kind: fields for kind, fields in TABLES.items() if kind not in (SOLVERS, SWEEPS)}
    solvers = TABLES[SOLVERS]
    sweeps = TABLES[SWEEPS]
    kind = replace(solvers["kind"], choices=(*_kinds(SOLVERS), *_kinds(SWEEPS)))
    both = {**solvers, "sweeps": replace(sweeps["sweeps"], default=None), "kind": kind}
    rules = {
        STUDY: {"oneOf": [_only(SOLVERS, sweeps), {"required": ["kind", "sweeps"],
                                                   **_only(SWEEPS, solvers)}]},
        SOLVER: {"oneOf": [{"required": [interface]} for interface in INTERFACES]},
    }  # fmt: skip
    return json_schema("A study", Tables({STUDY: both, **inner}), rules, STUDY)


def _kinds(top: str) -> tuple[str, ...]:
    return TABLES[top]["kind"].choices or ()


def _only(top: str, other: Mapping[str, Field]) -> dict[str, Any]:
    """The rule of a file of one kind, which has no field that only the other kind has."""
    strangers = [{"required": [name]} for name in other if name not in TABLES[top]]
    return {"properties": {"kind": {"enum": list(_kinds(top))}}, "not": {"anyOf": strangers}}
