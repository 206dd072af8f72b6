"""Step files that cannot be used, each a distinct cause."""

import json

import numpy as np
import pytest

from tests.cases import cases
from tests.errors.scene import changed, dotted, numeric_fields
from tests.helpers import planted_step
from tests.made import step_text

STEP = json.loads(step_text(planted_step(7)[0]))
"""n_a = 3, n_u = 4, contacts with 6, 4 and 6 rows."""
RANGE = "products of them exceed the range of float64; look for a wrong unit"
CAUSES = {
    # name: (change to the step, words of the sentence)
    "n_a without end": (("n_a", 10**12), "K_q: must be 1000000000000 x 1000000000000 numbers"),
    "a list of 40 axes": (("tau_a", np.zeros((1,) * 40).tolist()), "tau_a: must be 3 finite num"),
    "a ragged matrix": (("K_q", [[1], [1, 2], [3]]), "K_q: must be 3 x 3 finite numbers, in lists"),
    "five rows": (("contacts/1/rows", 5), "contacts[1].rows: must be 4 or 6 (got 5)"),
    "J of another unit": (("contacts/0/J/2/0", 1e200), RANGE),
    "a target of another unit": (("delta_q_bar_a/0", 1e308), RANGE),
}


def step_file(folder, record):
    path = folder / "step.json"
    path.write_text(record if isinstance(record, str) else json.dumps(record))
    return path


@cases("change, words", CAUSES)
def test_a_step_that_cannot_be_used_is_refused(tmp_path, refused, change, words):
    path = step_file(tmp_path, changed(STEP, change))
    sentence = refused("solve", path, "-o", tmp_path / "solution.json")
    assert words in sentence
    assert sentence.startswith(f"{path}: ") or words == RANGE


NO_NUMBERS = ("NaN", "-Infinity", "1e999", "1" * 400)


@pytest.mark.parametrize("field", list(numeric_fields(STEP)))
def test_values_that_are_no_number_are_refused_in_every_field(tmp_path, refused, field):
    text = json.dumps(changed(STEP, (field, "MARK")))
    name = dotted(STEP, field)
    # A count of many digits is a whole number: it is the matrix that cannot have that size.
    known = {"n_a": ("n_a", "K_q"), "n_u": ("n_u", "M_u")}.get(name, (name,))
    for number in NO_NUMBERS:
        sentence = refused("solve", step_file(tmp_path, text.replace('"MARK"', number)))
        assert sentence.startswith(tuple(f"{tmp_path / 'step.json'}: {field}: " for field in known))
