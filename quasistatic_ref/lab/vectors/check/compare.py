"""Two outputs of one layer side by side: their shape, and number by number."""

import math
from collections.abc import Collection, Iterator, Mapping
from typing import Any

from quasistatic_ref.lab.vectors.check.verdict import Difference, correct_digits
from quasistatic_ref.lab.vectors.trees import Json

OPTIONAL = {
    "qp": ("A_lam", "slack"),
    "step": ("A_lam", "forces"),
}
"""Fields that follow from others, and need not be answered."""
WRENCH = ("f_d1", "f_d2", "f_n", "tau_n")
"""Components of a contact's wrench."""

ROUNDING = 2.0**-49
"""Of the largest number of a list, such as a row: so much any answer may be off, since it may have
been summed in another order, in another frame."""

CONTACT = ("pair", "index", "phi", "n", "alpha", "beta", "d1", "d2", "J")
ORDER = (
    *CONTACT,
    "indices",
    *("H", "g", "A", "b", "delta_q", "lam", "A_lam", "slack", "wrench", "forces", "net"),
    *("q", "q_next"),
)
"""Fields in the order in which a step comes to them: what fails first is the cause of the rest."""


def field_names(output: Json) -> list[str]:
    """The fields of an output, and those of its contacts as ``contacts.phi``."""
    contacts = output.get("contacts")
    if not isinstance(contacts, list) or not all(isinstance(one, dict) for one in contacts):
        return [*output]
    return [*output, *dict.fromkeys(f"contacts.{name}" for one in contacts for name in one)]


def without(output: Json, names: Collection[str]) -> Json:
    """An output without some fields, as :func:`field_names` has them."""
    kept = {name: value for name, value in output.items() if name not in names}
    if len(field_names(kept)) > len(kept):
        kept["contacts"] = [
            {key: value for key, value in one.items() if f"contacts.{key}" not in names}
            for one in kept["contacts"]
        ]
    return kept


def shape_problem(layer: str, expected: Json, answer: Json) -> tuple[str, str] | None:
    """The first thing about an answer that is no output of its layer: field and sentence."""
    if not isinstance(answer, dict):
        return "", f"the output must be an object with the fields {', '.join(expected)}"
    optional = OPTIONAL.get(layer, ())
    for name in expected:
        if name not in answer and name not in optional:
            return name, f"{name} is missing"
    for name, value in answer.items():
        if name not in expected:
            known = ", ".join(expected)
            return name, f"{name} is no field of this output; its fields are {known}"
        problem = _mismatch(expected[name], value, name)
        if problem:
            return name, problem
    return None


def _mismatch(expected: Json, answer: Json, path: str) -> str | None:
    if isinstance(expected, dict):
        if not isinstance(answer, dict):
            return f"{path} must be an object"
        for name in expected:
            if name not in answer:
                return f"{path}.{name} is missing"
        for name, value in answer.items():
            if name not in expected:
                return f"{path}.{name} is unknown"
            if problem := _mismatch(expected[name], value, f"{path}.{name}"):
                return problem
        return None
    if isinstance(expected, list):
        if not isinstance(answer, list):
            return f"{path} must be a list of {len(expected)}"
        if len(answer) != len(expected):
            return f"{path} must have {len(expected)} entries, not {len(answer)}"
        for i, (one, other) in enumerate(zip(expected, answer, strict=True)):
            if problem := _mismatch(one, other, f"{path}[{i}]"):
                return problem
        return None
    if isinstance(expected, bool | str) or expected is None:
        return None if isinstance(answer, type(expected)) else f"{path} must be like {expected!r}"
    return number_problem(answer, path)


def number_problem(value: Json, path: str) -> str | None:
    """Why a value is not a finite number; None if it is one."""
    if value is None:
        return f"{path} must be a number, not null, which many programs write for NaN"
    if isinstance(value, bool) or not isinstance(value, int | float):
        return f"{path} must be a number, not {str(value)[:40]!r}"
    try:
        finite = math.isfinite(float(value))
    except OverflowError:
        finite = False
    return None if finite else f"{path} must be a finite number, not {str(value)[:40]}"


def leaves(value: Json, path: str = "") -> Iterator[tuple[str, Any]]:
    """Everything that is neither list nor object, with its place."""
    if isinstance(value, dict):
        for name in sorted(value):
            yield from leaves(value[name], f"{path}.{name}")
    elif isinstance(value, list):
        for i, entry in enumerate(value):
            yield from leaves(entry, f"{path}[{i}]")
    else:
        yield path, value


def parts(output: Json) -> dict[str, Json]:
    """The fields of an output; a list of objects of the same names as one field for each name.

    The contacts of a step become ``contacts.phi``, ``contacts.n``, ...; in the order of ORDER.
    """
    fields: dict[str, Json] = {}
    for name, value in output.items():
        first = value[0] if isinstance(value, list) and value else None
        names = first.keys() if isinstance(first, dict) else ()
        if names and all(isinstance(v, dict) and v.keys() == names for v in value):
            for inner in names:
                fields[f"{name}.{inner}"] = [entry[inner] for entry in value]
        else:
            fields[name] = value
    return dict(sorted(fields.items(), key=lambda item: _place(item[0])))


def _place(field: str) -> tuple[bool, int]:
    """Sort key by which fields of contacts come before fields computed from contacts."""
    name = field.rpartition(".")[2]
    return "." not in field, ORDER.index(name) if name in ORDER else len(ORDER)


def tolerance_of(tolerance: Mapping[str, Json], field: str) -> float:
    """The allowed error of a field [its unit]; 0 for fields without one, such as integers.

    ``contacts.phi`` is looked for under its whole name, its last part and its first part.
    """
    for name in (field, field.rpartition(".")[2], field.partition(".")[0]):
        if name in tolerance:
            return float(tolerance[name]["absolute"])
    return 0.0


def exact_tolerance_of(tolerance: Mapping[str, Json], field: str) -> float:
    """The error of a field that float64 allows [its unit], from which digits are counted.

    It does not depend on how many digits are asked for.
    """
    of_field = tolerance.get(field, {})
    return float(of_field["exact"]) if "exact" in of_field else tolerance_of(tolerance, field)


def difference(
    field: str, expected: Json, answer: Json, tolerance: float, exact: float | None = None
) -> Difference:
    """The worst number of one field; what is no number must be equal.

    Parameters
    ----------
    field : str
    expected, answer : object
    tolerance : float
        How far it may be off [its unit].
    exact : float, optional
        How far rounding in float64 may take it; by default the same [its unit].
    """
    worst = 0.0
    place = ""
    size = 0.0
    largest = _largest_of_lists(expected, of_contacts="." in field)
    for (path, one), (_, other) in zip(leaves(expected), leaves(answer), strict=True):
        if isinstance(one, bool | str) or one is None:
            if one != other:
                return Difference(field, path, math.inf, tolerance, 0.0)
            continue
        size = max(size, abs(one))
        error = abs(float(other) - float(one))
        if error <= ROUNDING * largest[path]:
            error = min(error, tolerance)
        if error > worst:
            worst = error
            place = path
    if field in ("wrench", "forces") and place:
        contact, component = place[1:-1].split("][")
        place += f", {WRENCH[int(component)]} of contact {contact},"
    return Difference(
        field,
        place,
        worst,
        tolerance,
        correct_digits(worst, size, tolerance if exact is None else exact),
    )


def _largest_of_lists(value: Json, *, of_contacts: bool) -> dict[str, float]:
    """For each number, by its place, the largest of the list that it stands in.

    A number that each contact has one of stands alone.
    """
    numbers = {
        path: abs(float(one))
        for path, one in leaves(value)
        if not (isinstance(one, bool | str) or one is None)
    }
    lists = {path: path.rpartition("[")[0] for path in numbers}
    largest: dict[str, float] = {}
    for path, size in numbers.items():
        largest[lists[path]] = max(size, largest.get(lists[path], 0.0))
    return {
        path: size if of_contacts and not lists[path] else largest[lists[path]]
        for path, size in numbers.items()
    }


def differences(
    expected: Json, answer: Json, tolerance: Mapping[str, Json]
) -> dict[str, Difference]:
    """The difference of every answered field, in the order of the layer's output."""
    ours = parts(expected)
    theirs = parts(answer)
    return {
        name: difference(
            name,
            value,
            theirs[name],
            tolerance_of(tolerance, name),
            exact_tolerance_of(tolerance, name),
        )
        for name, value in ours.items()
        if name in theirs
    }
