"""Solution files of version 1, as the program wrote them, are read; what is unproved is listed."""

import json
from pathlib import Path

import pytest

from quasistatic_ref.cli.solution_files import solution_read
from quasistatic_ref.cli.verify import refutation
from quasistatic_ref.step.files import step_from_record

FILES = json.loads(Path(__file__).with_name("solutions_of_version_1.json").read_text())
PROVED = ("exact", "exact in the ellipsoid", "enclosure", "infeasible")


def step_and_solution(path, file, **changes):
    """The step and the solution of a file, with fields of it or of its certificate changed."""
    step = step_from_record(FILES[file]["step"])
    record = json.loads(json.dumps(FILES[file]["solution"]))
    for name, value in changes.items():
        (record if name in record else record["certificate"])[name] = value
    path.write_text(json.dumps(record))
    return step, solution_read(path, step)


def test_the_files_are_of_version_1_and_of_every_kind():
    assert {one["solution"]["version"] for one in FILES.values()} == {1}
    assert set(FILES) == {*PROVED, "residual", "none"}


@pytest.mark.parametrize("kind", PROVED)
def test_what_was_true_is_verified(tmp_path, cli, kind):
    step = tmp_path / "step.json"
    solution = tmp_path / "solution.json"
    step.write_text(json.dumps(FILES[kind]["step"]))
    solution.write_text(json.dumps(FILES[kind]["solution"]))
    said = cli("verify", step, solution).out
    assert said.startswith("verified: ")
    assert "not checked: backend" in said
    assert ("certificate.residuals" in said) == (kind != "infeasible")
    assert ("certificate.multipliers_unique" in said) == (kind in PROVED[1:3])
    assert "backend" in json.loads(cli("verify", step, solution, "--json").out)["not_checked"]


@pytest.mark.parametrize("kind", ["residual", "none"])
def test_what_proved_nothing_is_refused_or_held_to_its_bound(tmp_path, kind):
    step, solution = step_and_solution(tmp_path / "x.json", kind)
    assert (refutation(step, solution) is None) == (kind == "residual")


@pytest.mark.parametrize("kind", ["exact", "exact in the ellipsoid", "enclosure", "residual"])
def test_a_claim_that_is_null_is_a_claim_that_is_missing(tmp_path, kind):
    record = FILES[kind]["solution"]
    claims = record["certificate"]
    for name in set(claims) - {"kind", "residuals"}:
        others = {other: claims[other] for other in claims if other != name}
        step, null = step_and_solution(tmp_path / "x.json", kind, certificate=others | {name: None})
        _, missing = step_and_solution(tmp_path / "x.json", kind, certificate=others)
        assert null.certificate == missing.certificate
        assert refutation(step, null) == refutation(step, missing)
