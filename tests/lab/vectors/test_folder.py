"""The committed vectors: valid, whole, what `generate` writes, and certified."""

import json

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from quasistatic_ref import Certificate, InputError, verify_answer
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.lab.vectors.generate import generate_folder, manifest_text, new_record
from quasistatic_ref.lab.vectors.layers.qp import cone_step, step_of
from tests.closeness import assert_within
from tests.lab.vectors.committed_cases import (
    LAYERS,
    PROGRAM,
    VECTORS,
    answer_file,
    by_size,
    cases,
    expected_of,
    few_written,
    right_answers,
)
from tests.made import text_written

MEBIBYTES = 25
"""Promised size of the folder."""


def violations(name, *values):
    """What of some values is not as a schema says."""
    schema = json.loads((VECTORS / "schemas" / f"{name}.schema.json").read_text())
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    return [error.message for value in values for error in validator.iter_errors(value)]


def contents(folder):
    """The bytes of every file of a folder, by its path inside."""
    paths = [path for path in folder.rglob("*") if path.is_file()]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


LARGE = "distance", "step", "derivative"
"""Layers of which a validator reads megabytes."""


@pytest.mark.parametrize(
    "layer", [pytest.param(one, marks=pytest.mark.long if one in LARGE else ()) for one in LAYERS]
)
def test_every_file_is_as_its_schema_says(layer, tmp_path):
    inputs = json.loads((VECTORS / "inputs" / f"{layer}.json").read_text())
    outputs = json.loads((VECTORS / "expected" / f"{layer}.json").read_text())
    answers = json.loads(answer_file(tmp_path, layer, right_answers(layer)).read_text())
    assert violations("inputs", inputs) == []
    assert violations("expected", outputs) == []
    assert violations("answers", answers) == []
    pairs = zip(inputs["cases"], outputs["cases"], strict=True)
    both = [{"input": case["input"], "output": record["output"]} for case, record in pairs]
    assert violations(layer, *both) == []


def test_the_manifest_names_every_file_by_its_content():
    files = contents(VECTORS)
    text = files.pop("manifest.json").decode()
    again = "run `quasistatic-ref vectors generate --out validation/vectors`"
    assert text == manifest_text(files), again
    assert violations("manifest", json.loads(text)) == []
    assert sum(map(len, files.values())) < MEBIBYTES * 2**20


def test_a_new_case_takes_the_packages_answer_where_the_plain_program_agrees(tmp_path, monkeypatch):
    few_written(tmp_path / "a", 2)
    path = tmp_path / "a" / "inputs" / "rows.json"
    path.write_text(path.read_text().replace('"id": "rows/', '"id": "rows/new_'))
    generate_folder(tmp_path / "a", tmp_path / "b")
    made = json.loads((tmp_path / "b/expected/rows.json").read_text())
    for record, case in zip(made["cases"], by_size("rows"), strict=False):
        old = expected_of("rows")[case.id]
        assert_within(record["output"]["A"], old["output"]["A"], old["tolerance"]["A"]["absolute"])
        assert (record["digits"], record["output"]["b"]) == ({}, old["output"]["b"])
        assert 0 < record["tolerance"]["A"]["absolute"] < 1e-8
    assert violations("expected", made) == []
    monkeypatch.setitem(PROGRAM, "rows", lambda case: {"A": [[0.0]], "b": [0.0]})
    with pytest.raises(InputError, match=r"rows/new_.*do not agree on one"):
        generate_folder(tmp_path / "a", tmp_path / "c")
    assert not (tmp_path / "c").exists()


def test_derivatives_have_no_new_cases():
    with pytest.raises(InputError, match="has no expected answer"):
        new_record("derivative", cases("derivative")[0])


def test_every_quadratic_program_is_verified_again_without_a_solver():
    refused = {}
    for case in cases("qp"):
        output = expected_of("qp")[case.id]["output"]
        written = output["certificate"]
        step = cone_step(case.input) if "second_order" in case.input else step_of(case.input)
        if "farkas" in output:
            refused[case.id] = farkas_refutation(step, written["farkas"])
            continue
        facts = {name: value for name, value in written.items() if name != "working_set"}
        active = tuple((0, i) for i in written.get("working_set", ()))  # of the step's own rows
        claims = Certificate(**facts, active=active, step=step)
        lam = np.array(output["lam"])
        delta_q = np.array(output["delta_q"])
        refused[case.id] = verify_answer(step, delta_q, claims.active, lam, claims).reason
    assert {name: reason for name, reason in refused.items() if reason} == {}


@pytest.mark.long
def test_the_committed_vectors_are_copied_byte_for_byte(tmp_path):
    generate_folder(VECTORS, tmp_path)
    assert contents(tmp_path) == contents(VECTORS)


def test_a_folder_may_be_generated_in_place(tmp_path):
    few_written(tmp_path, 3)
    text_written(tmp_path / "README.md", "words")
    assert generate_folder(tmp_path, tmp_path) == dict.fromkeys(LAYERS, 3)
    files = contents(tmp_path)
    assert len(files) == 2 + 2 * len(LAYERS)
    generate_folder(tmp_path, tmp_path)
    assert contents(tmp_path) == files
    assert files.pop("manifest.json").decode() == manifest_text(files)
