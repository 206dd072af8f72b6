"""Fields are taken once, checked, and nothing unknown is left over."""

import numpy as np
import pytest

from quasistatic_ref import InputError, ScenarioError
from quasistatic_ref.text.table_reader import TableReader
from tests.cases import cases, refusal
from tests.closeness import assert_same

READS = {
    "number at an open end": ({"x": 0}, lambda f: f.number("x", above=0), "t.x: must be greater"),
    "number too small": ({"x": -1}, lambda f: f.number("x", least=0), "t.x: must be at least 0"),
    "integer a float": ({"x": 1.0}, lambda f: f.integer("x"), "t.x: must be a whole number"),
    "boolean one": ({"x": 1}, lambda f: f.boolean("x"), "t.x: must be true or false"),
    "text no choice": (
        {"x": "fixd"},
        lambda f: f.text("x", choices=("fixed", "floating")),
        "t.x: is not a choice; did you mean 'fixed'?",
    ),
    "array a word": ({"x": ["a"]}, lambda f: f.array("x", (1,)), "t.x: must be 1 finite number"),
    "array ragged": ({"x": [[1], [1, 2]]}, lambda f: f.array("x", (2, 2)), "t.x: must"),
    "array too long": ({"x": [1, 2, 3]}, lambda f: f.array("x", (2,)), "t.x: must be 2 numbers"),
    "array too deep": ({"x": np.zeros((1,) * 40).tolist()}, lambda f: f.array("x", (1,)), "t.x: "),
    "table a list": ({"x": []}, lambda f: f.table("x"), "t.x: must be a table"),
}


@cases("table, read, says", READS)
def test_a_field_is_refused_by_its_full_name(table, read, says):
    with refusal(ScenarioError, says):
        read(TableReader(table, "t", ScenarioError))


def test_arrays_become_float64_of_the_asked_shape():
    fields = TableReader({"a": [[1, 2], [3, 4]], "b": []})
    a = fields.array("a", (2, 2))
    assert a.dtype == np.float64
    assert_same(a, [[1.0, 2.0], [3.0, 4.0]])
    assert fields.array("b", (0, 7)).shape == (0, 7)


def test_a_missing_field_is_its_default_whatever_that_is():
    fields = TableReader({})
    default = np.zeros(2)
    assert fields.number("a", None) is None
    assert fields.text("b", None, choices=("x",)) is None
    assert fields.array("c", (2,), default).tolist() == [0.0, 0.0]
    assert fields.integer("d", 3) == 3
    assert fields.boolean("e", False) is False


def test_close_refuses_a_misspelt_field_and_suggests_the_right_one():
    fields = TableReader({"mu_w": 0.1}, "contacts.grip")
    assert fields.number("mu_v", 0.5) == 0.5
    with pytest.raises(InputError, match=r"grip\.mu_w: is unknown; did you mean 'mu_v'"):
        fields.close()


def test_a_field_is_taken_once():
    fields = TableReader({"a": 1})
    assert "a" in fields
    assert fields.names_left() == ["a"]
    fields.take("a")
    assert "a" not in fields
    with pytest.raises(InputError, match="a: is missing"):
        fields.take("a")
