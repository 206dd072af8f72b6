"""``verify`` tells a true answer from a false one."""

import json

import pytest

from quasistatic_ref import save_step
from tests.helpers import one_sentence, pinch, point_on_floor


def test_verify_says_that_an_answer_is_false_and_names_a_file_that_is_missing(tmp_path, cli):
    step = save_step(tmp_path / "step.json", point_on_floor(force=(0.5, 0.0, -3.0)))
    false = tmp_path / "false.json"
    cli("solve", step, "-o", false)
    false.write_text(false.read_text().replace('"delta_q": [', '"delta_q": [1'))
    assert json.loads(cli("verify", step, false, "--json", status=1).out)["verified"] is False
    assert cli("verify", step, false, status=1).out.startswith("refuted: delta_q[0] is 1")
    assert one_sentence(cli("verify", step, tmp_path / "none.json", status=2).err).endswith(
        "none.json: no such file"
    )
    for alone in (step, false):
        assert one_sentence(cli("verify", alone, status=2).err).endswith(
            f"{alone}: is one of two files: give the step file, then its solution file"
        )


NAMES = ("product", "facets-6", "frictionless", "ellipsoid")


@pytest.mark.parametrize("name", NAMES)
def test_a_solution_in_another_cone_is_verified_in_that_cone_only(name, tmp_path, cli):
    step = tmp_path / "step.json"
    solution = tmp_path / "solution.json"
    save_step(step, pinch(grip=5.0, offset=0.2))
    cli("solve", step, "--cone", name, "-o", solution)
    assert "verified" in cli("verify", step, solution, "--cone", name).out
    assert (
        "cone: must be that of the step, 'pyramid'" in cli("verify", step, solution, status=2).err
    )
