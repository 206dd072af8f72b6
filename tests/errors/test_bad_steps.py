"""Step and solution files that cannot be used, each a distinct cause; and wrong answers."""

import json

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.formats.files import plain
from quasistatic_ref.step.files import step_record
from tests.errors.scene import changed, dotted, numeric_fields
from tests.helpers import planted_step

STEP = plain(step_record(planted_step(np.random.default_rng(7))[0]))
"""n_a = 3, n_u = 4, contacts with 6, 4 and 6 rows."""
ONE = "contacts/1/"
CAUSES = {
    # name: (changes to the step, the field named, words of the sentence)
    "n_a without end": (("n_a", 10**12), "K_q", "must be 1000000000000 x 1000000000000 numbers"),
    "five rows": ((ONE + "rows", 5), "contacts[1].rows", "must be 4 or 6 (got 5)"),
}  # fmt: skip


def written(folder, record, name="step.json"):
    path = folder / name
    path.write_text(record if isinstance(record, str) else json.dumps(record))
    return path


@pytest.mark.parametrize("cause", CAUSES)
def test_a_step_that_cannot_be_used_is_refused(tmp_path, refused, cause):
    *changes, field, words = CAUSES[cause]
    path = written(tmp_path, changed(STEP, *changes))
    sentence = refused("solve", path, "-o", tmp_path / "solution.json")
    assert sentence.startswith(f"{path}: {field}: ")
    assert words in sentence


NO_NUMBERS = ("NaN", "-Infinity", "1e999", "1" * 400)


@pytest.mark.parametrize("field", list(numeric_fields(STEP)))
def test_what_is_no_number_is_refused_in_every_field(tmp_path, refused, field):
    text = json.dumps(changed(STEP, (field, "MARK")))
    name = dotted(STEP, field)
    # A count of many digits is a whole number: it is the matrix that cannot have that size.
    known = {"n_a": ("n_a", "K_q"), "n_u": ("n_u", "M_u")}.get(name, (name,))
    for number in NO_NUMBERS:
        sentence = refused("solve", written(tmp_path, text.replace('"MARK"', number)))
        assert sentence.startswith(tuple(f"{tmp_path / 'step.json'}: {field}: " for field in known))


def test_a_step_whose_products_leave_the_range_says_so(tmp_path, refused):
    path = written(tmp_path, changed(STEP, ("tau_u/0", 7.4e156)))
    sentence = refused("solve", path)
    assert "products of them exceed the range of float64; look for a wrong unit" in sentence


@pytest.fixture(scope="module")
def solved(tmp_path_factory):
    """The good step, in a folder with its true solution."""
    folder = tmp_path_factory.mktemp("solved")
    step = written(folder, STEP)
    solution = folder / "solution.json"
    assert main(["solve", str(step), "-o", str(solution)]) == 0
    return step, json.loads(solution.read_text())


PROOF = (("status", "infeasible"), *((key, ...) for key in (
    "delta_q", "lam", "lam_extra", "wrench", "certificate",
)))  # fmt: skip
FALSE = {
    "another step's": (("step_sha256", "0" * 64), "belongs to another step"),
    "one digit off": (("delta_q/0", 0.125), "delta_q[0] is 0.125; the exact one rounds to"),
    "a bound that is none": (
        ("certificate", {"kind": "residual", "error_bound": None}), "without a bound proves",
    ),
    "a proof of 1e999999999": (
        *PROOF, ("farkas", ["1e999999999"] * 16), "entries that are no fractions",
    ),
}  # fmt: skip


@pytest.mark.parametrize("cause", FALSE)
def test_an_answer_that_is_wrong_is_refuted_with_status_1(tmp_path, solved, capsys, cause):
    *changes, words = FALSE[cause]
    step, solution = solved
    path = written(tmp_path, changed(solution, *changes))
    assert main(["verify", str(step), str(path)]) == 1
    captured = capsys.readouterr()
    assert captured.out.startswith("refuted: ")
    assert words in captured.out
    assert captured.err == ""
