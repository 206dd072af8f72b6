"""The files of the vectors: JSON with sorted keys, one case a line, floats as they round-trip.

A shape that several cases use, such as a cloud of 992 points, stands once in the file's table
``shapes``; a case names it as ``{"kind": "shared", "name": ...}``.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.text.content import json_read, text_written
from quasistatic_ref.text.json_text import plain
from quasistatic_ref.text.table_reader import TableReader

VERSION = 1
INPUTS = "quasistatic-ref/vectors-inputs"
EXPECTED = "quasistatic-ref/vectors-expected"
ANSWERS = "quasistatic-ref/vectors-answers"
SHARED = "shared"


@dataclass(frozen=True)
class Case:
    """One input of a layer, by its name.

    Parameters
    ----------
    id : str
        ``LAYER/FAMILY/NAME``.
    provenance : str
        One sentence: where its numbers come from.
    input : dict
        What the layer is given.
    """

    id: str
    provenance: str
    input: Json


def lines(record: dict[str, Json], listed: Sequence[str] = ("cases", "answers")) -> str:
    """A JSON object with sorted keys; of the fields in `listed`, one entry a line."""
    parts = []
    for name in sorted(record):
        if name in listed and record[name]:
            entries = ",\n".join(line(entry) for entry in record[name])
            parts.append(f"{line(name)}: [\n{entries}\n]")
        else:
            parts.append(f"{line(name)}: {line(record[name])}")
    return "{" + ",\n".join(parts) + "}\n"


def line(value: Any) -> str:
    """One value as one line of JSON, keys sorted, -0.0 written 0.0; NaN is refused."""
    return json.dumps(plain(value), sort_keys=True, allow_nan=False, ensure_ascii=False)


def inputs_read(folder: str | Path, layer: str) -> list[Case]:
    """The inputs of a layer from a folder of vectors, shared shapes in their places.

    Raises
    ------
    InputError
        Naming the file and the field.
    """
    path = Path(folder) / "inputs" / f"{layer}.json"
    try:
        top = fields_after_head(path, INPUTS, layer)
        shapes = top.take("shapes", {})
        cases = []
        for one in top.tables("cases"):
            case_input = _whole(one.take("input"), shapes)
            cases.append(Case(one.text("id"), one.text("provenance"), case_input))
            one.close()
        top.close()
        _check_ids([case.id for case in cases])
    except InputError as error:
        raise error.in_file(path) from None
    return cases


def expected_text(layer: str, records: Sequence[dict[str, Json]]) -> str:
    """The file of what a layer is expected to answer, from `Expected.json` and each case's id."""
    return lines({"format": EXPECTED, "version": VERSION, "layer": layer, "cases": list(records)})


def expected_read(folder: str | Path, layer: str) -> dict[str, dict[str, Json]]:
    """What a layer is expected to answer, by the id of the case."""
    path = Path(folder) / "expected" / f"{layer}.json"
    try:
        top = fields_after_head(path, EXPECTED, layer)
        readers = [*top.tables("cases")]
        top.close()
        ids = [one.text("id") for one in readers]
        _check_ids(ids)
    except InputError as error:
        raise error.in_file(path) from None
    return {name: one.fields for name, one in zip(ids, readers, strict=True)}


def answers_written(
    folder: str | Path, layer: str, implementation: str, outputs: dict[str, Json]
) -> Path:
    """Write the answers of one layer, in our conventions, to a folder: whole or not at all."""
    record = {"format": ANSWERS, "version": VERSION, "layer": layer}
    record |= {"implementation": implementation, "tangent": "body", "quaternion": "xyzw"}
    answers = [{"id": name, "output": output} for name, output in outputs.items()]
    return text_written(Path(folder) / f"{layer}.json", lines({**record, "answers": answers}))


def check_layer(name: str, option: str | None = None) -> str:
    """The name of a layer; InputError if no layer has it, naming the option that wrote it."""
    if name not in LAYERS:
        problem = f"is not a layer{suggestion(name, LAYERS)}"
        if option is not None:
            raise InputError(problem, field=option)
        raise InputError(problem, field="layer", value=name)
    return name


def fields_after_head(path: Path, wanted: str, layer: str) -> TableReader:
    """The fields of a file after its head, which says its format, version and layer."""
    top = TableReader(json_read(path))
    top.check_format(wanted, VERSION)
    top.text("layer", choices=(layer,))
    return top


def _check_ids(ids: Sequence[str]) -> None:
    twice = next((name for name in ids if ids.count(name) > 1), None)
    if twice is not None:
        raise InputError("is the id of two cases; rename one", field="id", value=twice)


def _whole(value: Json, shapes: Json) -> Json:
    """A case with the shapes that its file keeps in a table."""
    if isinstance(value, list):
        return [_whole(one, shapes) for one in value]
    if not isinstance(value, dict):
        return value
    if value.get("kind") != SHARED:
        return {key: _whole(one, shapes) for key, one in value.items()}
    name = TableReader(value).text("name")
    if name not in shapes:
        raise InputError("is not a shape of this file", field="shapes", value=name)
    return shapes[name]
