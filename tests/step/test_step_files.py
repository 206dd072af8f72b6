"""Steps and solutions as JSON: bit for bit, every unknown or missing field refused by name."""

import hashlib
import json

import numpy as np
import pytest

from quasistatic_ref.errors import InputError, StepDataError
from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.step.data import Extra
from quasistatic_ref.step.files import (
    step_from_record,
    step_read,
    step_sha256,
    step_text,
    step_written,
)
from tests.helpers import point_on_floor, random_step, record_changed

RNG = np.random.default_rng(11)
PLAIN = random_step(RNG, n_a=2, n_u=3, rows=(6, 4))
OWN = Extra(("limit", "wall"), RNG.normal(size=(2, 5)), RNG.normal(size=2))
STEPS = {
    "plain": PLAIN,
    "with rows of one's own": PLAIN.replace(extra=OWN),
    "without contacts": PLAIN.replace(contacts=no_contacts(5)),
    "nothing actuated": point_on_floor(),
    "everything actuated": random_step(RNG, n_a=3, n_u=0, rows=(4,)),
}


STEP_FIELDS = [
    "format", "version", "cone", "h", "n_a", "n_u", "K_q", "M_u", "tau_a", "tau_u",
    "delta_q_bar_a", "contacts",
]  # fmt: skip


CONTACT_FIELDS = ["name", "phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows"]


def record_of(step):
    return json.loads(step_text(step))


@pytest.mark.parametrize("step", STEPS.values(), ids=STEPS)
def test_a_step_read_back_is_the_same_bits(tmp_path, step):
    path = step_written(tmp_path / "step.json", step)
    back = step_read(path)
    assert back == step
    assert step_text(back) == step_text(step) == path.read_text()
    assert step_sha256(back) == step_sha256(step)


def test_the_file_has_the_documented_fields_in_order():
    record = record_of(STEPS["with rows of one's own"])
    assert list(record) == [*STEP_FIELDS, "extra"]
    assert list(record["contacts"][0]) == CONTACT_FIELDS
    assert list(record["extra"]) == ["names", "A", "b"]
    assert "extra" not in record_of(PLAIN)
    assert (record["format"], record["version"], record["cone"]) == (
        "quasistatic-ref/step", 1, "pyramid",
    )  # fmt: skip


BY_HAND = (
    '{"format": "quasistatic-ref/step", "version": 1, "cone": "pyramid", "h": 0.01, "n_a": 0, '
    '"n_u": 3, "K_q": [], "M_u": [[0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.3]], '
    '"tau_a": [], "tau_u": [0.5, 0.0, -2.0], "delta_q_bar_a": [], "contacts": [{"name": "c0", '
    '"phi": 0.001, "n": [0.0, 0.0, 1.0], "d1": [1.0, 0.0, 0.0], "d2": [0.0, 1.0, 0.0], '
    '"J": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]], "mu_v": 0.5, '
    '"mu_omega": 0.0, "rows": 4}]}\n'
)


def test_a_step_is_written_as_by_hand_and_hashed_by_its_text():
    step = point_on_floor(m=0.3, phi=0.001, force=(0.5, 0.0, -2.0))
    assert step_text(step) == BY_HAND
    assert step_sha256(step) == hashlib.sha256(BY_HAND.encode()).hexdigest()


def test_cone_and_extra_may_be_left_out():
    record = record_changed(record_of(PLAIN), ["cone"])
    assert step_from_record(record) == PLAIN


MISSING = (["h"], ["contacts"], ["contacts", 1, "rows"], ["extra", "b"])


@pytest.mark.parametrize("path", MISSING, ids=[".".join(map(str, p)) for p in MISSING])
def test_a_missing_field_is_named(path):
    record = record_changed(record_of(STEPS["with rows of one's own"]), path)
    name = ".".join(str(p) for p in path).replace(".1.", "[1].")
    with pytest.raises(StepDataError) as caught:
        step_from_record(record)
    assert str(caught.value) == f"{name}: is missing"


UNKNOWN = {
    "at the top": (["stiffness"], "stiffness: is unknown"),
    "nearly K_q": (["K_Q"], "K_Q: is unknown; did you mean 'K_q'?"),
    "in a contact": (["contacts", 0, "mu"], "contacts[0].mu: is unknown; did you mean 'mu_v'?"),
    "in extra": (["extra", "c"], "extra.c: is unknown"),
}


@pytest.mark.parametrize(("path", "says"), UNKNOWN.values(), ids=UNKNOWN)
def test_an_unknown_field_is_refused_by_name(path, says):
    record = record_changed(record_of(STEPS["with rows of one's own"]), path, 1.5)
    with pytest.raises(StepDataError) as caught:
        step_from_record(record)
    assert str(caught.value).startswith(says)
    assert caught.value.value == 1.5


REFUSED = {
    "another format": (["format"], "ref/solution", "format: must be 'quasistatic-ref/step' (got "),
    "a later version": (["version"], 2, "version: is not known here; this program reads 1 (got 2)"),
    "a version in words": (["version"], "1", "version: must be a whole number"),
    "h a word": (["h"], "0.01", "h: must be a number (got '0.01')"),
    "n_a negative": (["n_a"], -1, "n_a: must be at least 0"),
    "n_a wrong": (["n_a"], 3, "K_q: must be 3 x 3 numbers"),
    "n_u wrong": (["n_u"], 2, "M_u: must be 2 x 2 numbers"),
    "K_q flat": (["K_q"], [1.0, 2.0, 3.0, 4.0], "K_q: must be 2 x 2 numbers"),
    "tau_a true": (["tau_a"], [True, 0.0], "tau_a: must contain numbers only"),
    "contacts a table": (["contacts"], {"a": 1}, "contacts: must be a list"),
    "a contact a list": (["contacts", 1], [1], "contacts[1]: must be a table of named fields"),
    "name a number": (["contacts", 0, "name"], 3, "contacts[0].name: must be a string"),
    "J too narrow": (["contacts", 0, "J"], [[0.0] * 4] * 4, "contacts[0].J: must be 4 x 5"),
    "extra a list": (["extra"], [1], "extra: must be a table"),
    "extra names a number": (["extra", "names"], [1, 2], "extra.names: must be a list of strings"),
}


@pytest.mark.parametrize(("path", "value", "says"), REFUSED.values(), ids=REFUSED)
def test_a_wrong_value_is_refused_with_its_field(path, value, says):
    record = record_changed(record_of(STEPS["with rows of one's own"]), path, value)
    with pytest.raises(StepDataError) as caught:
        step_from_record(record)
    assert str(caught.value).startswith(says)


@pytest.mark.parametrize("record", [None, [], "step", 3.0, True])
def test_what_is_no_table_is_no_step(record):
    with pytest.raises(StepDataError, match="must be a table of named fields"):
        step_from_record(record)


def test_an_error_in_a_file_names_the_file(tmp_path):
    path = tmp_path / "step.json"
    path.write_text(json.dumps(record_changed(record_of(PLAIN), ["h"], -1.0)))
    with pytest.raises(InputError) as caught:
        step_read(path)
    assert str(caught.value) == f"{path}: h: must be greater than 0 (got -1.0)"
