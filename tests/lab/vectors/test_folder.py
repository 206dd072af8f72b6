"""The committed vectors: valid, whole, what `generate` writes, and certified."""

import json

import numpy as np
import pytest
from jsonschema import Draft202012Validator

from quasistatic_ref import InputError, verify_answer
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.vectors.files import line
from quasistatic_ref.lab.vectors.generate import expected_record, generate_folder, manifest_text
from quasistatic_ref.lab.vectors.layers import COMPUTED, FILES, LAYERS
from quasistatic_ref.lab.vectors.layers.qp import claimed_certificate, cone_step, step_of
from quasistatic_ref.lab.vectors.versions import MANIFEST
from tests.lab.vectors.committed_cases import (
    VECTORS,
    answer_file,
    cases,
    expected_of,
    few_written,
    right_answers,
)
from tests.meta.test_layers import printed_text

MEBIBYTES = 25
"""Promised size of the folder."""
EVERY = {"qp": 12}
"""Every so many cases of a layer are computed again; of the others, which take no time, all."""


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
    text = files.pop(MANIFEST).decode()
    again = "run `quasistatic-ref vectors generate --out validation/vectors`"
    assert text == manifest_text(files), again
    assert violations("manifest", json.loads(text)) == []
    assert sum(map(len, files.values())) < MEBIBYTES * 2**20


@pytest.mark.parametrize("layer", COMPUTED)
def test_what_is_computed_again_is_what_is_committed_byte_for_byte(layer):
    committed = (VECTORS / "expected" / f"{layer}.json").read_text().splitlines()
    records = {text.rstrip(",") for text in committed}
    for case in cases(layer)[:: EVERY.get(layer, 1)]:
        assert line(expected_record(layer, case)) in records, case.id


@pytest.mark.parametrize("layer", FILES)
def test_cases_without_the_answers_that_are_copied_are_refused(layer, tmp_path):
    few_written(tmp_path / "a", 1, {*FILES} - {layer})
    with pytest.raises(InputError, match=rf"expected/{layer}\.json.*is missing"):
        generate_folder(tmp_path / "a", tmp_path / "b")
    assert not (tmp_path / "b").exists()


def test_every_quadratic_program_is_verified_again_without_a_solver():
    refused = {}
    for case in cases("qp"):
        output = expected_of("qp")[case.id]["output"]
        conic = "second_order" in case.input
        step = cone_step(case.input) if conic else step_of(case.input)
        if "farkas" in output:
            refused[case.id] = farkas_refutation(step, output["certificate"]["farkas"])
            continue
        claims = claimed_certificate(case.input, output, step)
        lam = np.array(output["lam"])
        delta_q = np.array(output["delta_q"])
        refused[case.id] = verify_answer(step, delta_q, claims.active, lam, claims).reason
    assert {name: reason for name, reason in refused.items() if reason} == {}


def test_generating_twice_or_in_place_gives_identical_bytes(tmp_path):
    few_written(tmp_path / "a", 3)
    for path in ("README.md", "LICENSE.md", "schemas/rows.schema.json"):
        text_written(tmp_path / "a" / path, (VECTORS / path).read_text())
    counts = generate_folder(tmp_path / "a", tmp_path / "b")
    assert counts == dict.fromkeys(LAYERS, 3)
    generate_folder(tmp_path / "a", tmp_path / "a")
    files = contents(tmp_path / "b")
    assert contents(tmp_path / "a") == files
    assert len(files) == 1 + 3 + 2 * len(LAYERS)
    assert files.pop(MANIFEST).decode() == manifest_text(files)


def test_outputs_are_computed_without_robotics_stack_backends_and_blas(tmp_path):
    few = {layer: cases(layer)[0].id for layer in COMPUTED}
    source = f"""
import sys
for name in ("pinocchio", "coal", "cvxpy", "qpsolvers", "scipy"): sys.modules[name] = None
import numpy as np
def refused(*_, **__): raise AssertionError("linear algebra or libm in float64")
for name in ("solve", "inv", "qr", "svd", "eigh", "lstsq", "cholesky"):
    setattr(np.linalg, name, refused)
for name in ("sin", "cos", "exp", "log", "arctan2", "sqrt", "hypot"): setattr(np, name, refused)
from quasistatic_ref.lab.vectors.files import inputs_read
from quasistatic_ref.lab.vectors.generate import expected_record
for layer, wanted in {few!r}.items():
    (case,) = (c for c in inputs_read({str(VECTORS)!r}, layer) if c.id == wanted)
    assert expected_record(layer, case)["output"]
print("done")
"""
    assert printed_text(source) == "done"
