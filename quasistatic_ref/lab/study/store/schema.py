"""What the files of a store may hold: ``study.json``, its rows, and the facts of its problems.

A shape is a kind of value, a table of shapes by name, or a list of one shape. A file that departs
from its shape is refused by line, field and value.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.measuring.grade import CLOCKS, OUTCOMES
from quasistatic_ref.lab.study.problems.qp import UNITS

Kind = tuple[str, Callable[[Any], bool]]
Shape = Kind | dict[str, Any] | list[Any]
LONGEST_TEXT = 1000
"""Most characters of a name or a status: columns of text are as wide as the longest."""


def _is_number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return -1e300 < value < 1e300


def _is_count(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2**31


def _is_text(value: Any) -> bool:
    return isinstance(value, str) and len(value) <= LONGEST_TEXT


def _or_null(kind: Kind) -> Kind:
    return f"{kind[0]}, or null", lambda value: value is None or kind[1](value)


def _among(words: Sequence[str]) -> Kind:
    return f"one of {', '.join(words)}", lambda value: isinstance(value, str) and value in words


def _table_of(kind: Kind) -> Kind:
    return (
        f"a table whose values are each {kind[0]}",
        lambda value: isinstance(value, dict) and all(map(kind[1], value.values())),
    )


NUMBER: Kind = ("a finite number", _is_number)
POSITIVE: Kind = ("a number greater than 0", lambda v: _is_number(v) and v > 0)
TIME: Kind = ("a number from 0 on", lambda v: _is_number(v) and v >= 0)
COUNT: Kind = ("a whole number from 0 on", _is_count)
TEXT: Kind = (f"a string of at most {LONGEST_TEXT} characters", _is_text)
FLAG: Kind = ("true or false", lambda value: isinstance(value, bool))
MAYBE = _or_null(NUMBER)
VALUE: Kind = ("a number or a word", lambda v: _is_number(v) or isinstance(v, bool) or _is_text(v))
ANYTHING: Kind = ("anything", lambda value: True)

SOLVER_ROW: dict[str, Any] = {
    "problem": TEXT, "family": TEXT, "solver": TEXT, "interface": TEXT, "setting": TEXT,
    "warm": FLAG, "units": _among(UNITS), "repetition": COUNT, "outcome": _among(OUTCOMES),
    "claimed": TEXT, "feasible": FLAG, "said_optimal": FLAG, "said_infeasible": FLAG,
    "wrong": FLAG, "wrong_multipliers": FLAG,
    "digits": {"delta_q": MAYBE, "net_wrench": MAYBE, "multipliers": MAYBE},
    "residuals": _table_of(MAYBE),
    "seconds": {**dict.fromkeys(CLOCKS, _or_null(TIME)), "spent": TIME},
    "calls": COUNT, "clock_agrees": _or_null(FLAG), "memory": MAYBE, "iterations": MAYBE,
}  # fmt: skip
MERGED_ROW: Shape = {**SOLVER_ROW, "machine": TEXT}
"""Of a store into which the results of several machines were merged."""
SWEEP_ROW: Shape = {
    "sweep": TEXT, "scenario": TEXT, "values": _table_of(VALUE), "outcome": TEXT,
    "reason": _or_null(("a string", lambda value: isinstance(value, str))),
    "measures": _table_of(MAYBE), "seconds": {"call": TIME},
}  # fmt: skip
FACT: Shape = {
    "id": TEXT, "family": TEXT, "contacts": COUNT, "mass_ratio": MAYBE, "h": MAYBE, "k": COUNT,
    "n": COUNT, "m": COUNT, "condition": MAYBE, "condition_natural": MAYBE, "kind": TEXT,
    "bound": NUMBER,
}  # fmt: skip
_PLACE: dict[str, Any] = {"machine": _table_of(ANYTHING), "versions": _table_of(ANYTHING)}
STUDIES: dict[str, Shape] = {
    "solvers": {
        "time_limit": POSITIVE,
        "settings": [{"name": TEXT, "accuracy": MAYBE, "promised": NUMBER, "tuned": FLAG}],
        "solvers": [
            {
                "name": TEXT,
                "interface": TEXT,
                "options": _table_of(("a table", _table_of(ANYTHING)[1])),
            }
        ],
        **_PLACE,
    },
    "sweep": {
        "sweeps": [{"name": TEXT, "scenario": TEXT, "link": TEXT, "since": NUMBER}],
        **_PLACE,
    },
}
"""``study.json`` by its kind."""


def checked(value: Any, shape: Shape, where: str = "", strict: bool = False) -> None:
    """Refuse a value that departs from its shape.

    Parameters
    ----------
    value : object
        As parsed from JSON.
    shape : tuple, dict or list
    where : str
        Name of the value.
    strict : bool
        Whether a table may hold no names but those of its shape.

    Raises
    ------
    InputError
        Naming the field within the value, what it must be, and what it is.
    """
    if isinstance(shape, tuple):
        words, holds = shape
        if not holds(value):
            raise InputError(f"must be {words}", field=where, value=_shown(value))
    elif isinstance(shape, dict):
        if not isinstance(value, dict):
            raise InputError("must be a table", field=where or None, value=_shown(value))
        for name, inner in shape.items():
            field = f"{where}.{name}" if where else name
            if name not in value:
                raise InputError("is missing", field=field)
            checked(value[name], inner, field, strict)
        if strict and (unknown := next((name for name in value if name not in shape), None)):
            raise InputError("is unknown", field=f"{where}.{unknown}" if where else unknown)
    else:
        if not isinstance(value, list):
            raise InputError("must be a list", field=where, value=_shown(value))
        for i, one in enumerate(value):
            checked(one, shape[0], f"{where}[{i}]", strict)


def _shown(value: Any) -> Any:
    """The value for a message, in which None stands for no value."""
    return "null" if value is None else value


def check_machines(study: Mapping[str, Any]) -> None:
    """Refuse a merged study whose machines are not named, or not described.

    Raises
    ------
    InputError
        Naming the field.
    """
    checked(study["machines"], [TEXT], "machines")
    for name in ("machine", "versions"):
        own = dict.fromkeys(study["machines"], _table_of(ANYTHING))
        checked(study[name], own, name)


def check_solver_rows(
    study: Mapping[str, Any], facts: Sequence[Mapping[str, Any]], rows: Sequence[Mapping[str, Any]]
) -> None:
    """Refuse rows of solvers, settings or families that the study does not know.

    Raises
    ------
    InputError
        Naming the field and the value.
    """
    settings = {setting["name"] for setting in study["settings"]}
    options = {(s["interface"], s["name"]): s["options"] for s in study["solvers"]}
    families = {fact["family"] for fact in facts}
    machines = study.get("machines", [None])
    for row in rows:
        if row.get("machine") not in machines:
            raise _stranger("machine", str(row.get("machine")))
        if row["family"] not in families:
            raise _stranger("family", row["family"])
        if (row["interface"], row["solver"]) not in options:
            raise _stranger("solver", f"{row['interface']}:{row['solver']}")
        if row["setting"] not in settings & set(options[row["interface"], row["solver"]]):
            raise _stranger("setting", row["setting"])


def check_sweep_rows(study: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> None:
    """Refuse rows of another sweep than the study's, or of other axes than their sweep's.

    Raises
    ------
    InputError
        Naming the field and the value.
    """
    axes: dict[str, list[str] | None] = {sweep["name"]: None for sweep in study["sweeps"]}
    for row in rows:
        if row["sweep"] not in axes:
            raise _stranger("sweep", row["sweep"])
        own = list(row["values"])
        if not own or own != (axes[row["sweep"]] or own):
            raise InputError("must name the axes of its sweep", field="values", value=own)
        axes[row["sweep"]] = own
        for name in ("rotation_deg", "boundary_layer_um"):
            if row["outcome"] == "done" and row["measures"].get(name) is None:
                raise InputError("is missing", field=f"measures.{name}")


def _stranger(field: str, value: str) -> InputError:
    problem = "is not one of this study; its rows belong to another"
    return InputError(problem, field=f"a row's {field}", value=value)
