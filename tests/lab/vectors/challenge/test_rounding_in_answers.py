"""What rounding leaves in an answer is no mistake, and is written as JSON that any reader takes."""

import json

import pytest

from quasistatic_ref.lab.vectors.challenge.finding import Failure
from quasistatic_ref.lab.vectors.check.multipliers import multipliers_problem

# min x^2/2 - g x with x + 1 >= 0, x* = g: at g = 1/64 the row is idle. The free step's energy is
# g^2 = 2^-12; float64 leaves 2^-53 of it in the gap, so that lam * slack of 1e-20 is rounding.
G = 1 / 64
SMALL = 1e-20
LARGE = 1e-9
EXPECTED = {
    "output": {"delta_q": [G], "A_lam": [0.0], "slack": [1 + G, 0.0, 0.0, 0.0]},
    "tolerance": {name: {"absolute": 2**-26 * G} for name in ("delta_q", "A_lam", "slack")},
}


@pytest.mark.parametrize("conic", [False, True])
def test_forces_of_rounding_size_where_nothing_presses_are_no_mistake(conic):
    rows = [[1.0], [0.0], [0.0], [0.0]]
    for lam, wrong in ((SMALL, False), (LARGE, True)):
        said = multipliers_problem(rows, EXPECTED, [lam, 0.0, 0.0, 0.0], conic=conic)
        assert (said is not None) == wrong, said


def test_a_counterexample_is_json_without_nan_and_infinity(tmp_path):
    given = {"x": [float("nan"), 1.0]}
    expected = {"x": [0.5, float("inf")]}
    finding = Failure("qp/1", "qp", "wrong", "x", "it is", {}, expected, given)
    folder = finding.write_folder(tmp_path, "./sim")

    def refused(word):
        raise AssertionError(f"{word} is no JSON")

    text = (folder / "counterexample.json").read_text()
    record = json.loads(text, parse_constant=refused)
    assert record["given"]["x"] == ["nan", 1.0]
    assert record["expected"]["x"] == [0.5, "inf"]
