"""A scenario with random nested keys is taken, or refused in a sentence, in little memory."""

import tracemalloc

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from quasistatic_ref import InputError, load_scenario
from tests.errors.scene import scene_written

LONGEST = 2000
"""Most characters of a sentence."""
MEMORY = 16 << 20
"""Most bytes that a scenario of at most 40 kB may take."""
PART = st.sampled_from(
    ("a", "b", "contacts", "bodies", "floor", "mu_v", '"quoted.name"', "'literal'", '""', "0",
     r'"\""', r'"\\"', r'"a\u0022.b"', r"'\'")
)  # fmt: skip
DEPTH = st.one_of(st.integers(1, 12), st.sampled_from((100, 1200, 5000)))


@st.composite
def keys(draw):
    """A key of many parts: some drawn, again and again."""
    parts = draw(st.lists(PART, min_size=1, max_size=12))
    depth = draw(DEPTH)
    return draw(st.sampled_from((".", " . "))).join((parts * depth)[:depth])


@st.composite
def tables(draw, depth=0):
    """The value of a key: a number, a list, or an inline table of further keys."""
    kind = draw(st.sampled_from("1[{" if depth < 3 else "1"))
    if kind == "1":
        return draw(st.sampled_from(("1", "-1.5", '"word"', "nan", "[[[[]]]]")))
    inner = draw(tables(depth + 1))
    return f"[{inner}, {inner}]" if kind == "[" else f"{{{draw(keys())} = {inner}}}"


@st.composite
def lines(draw):
    """A table, an array of tables, or a key with its value."""
    form = draw(st.sampled_from(("[{}]", "[[{}]]", "{} = ")))
    return form.format(draw(keys())) + (draw(tables()) if form.endswith(" ") else "")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(more=st.lists(lines(), min_size=1, max_size=4), first=st.booleans())
def test_nested_keys_are_taken_or_refused_in_a_sentence(tmp_path, more, first):
    path = scene_written(tmp_path)
    text = path.read_text("utf-8")
    added = "\n".join(more)
    path.write_text(f"{added}\n{text}" if first else f"{text}\n{added}\n", "utf-8")
    tracemalloc.start()
    try:
        load_scenario(path)
    except InputError as error:
        sentence = str(error)
        assert str(path) in sentence
        assert len(sentence) <= LONGEST
        assert "\n" not in sentence
    finally:
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    assert most <= MEMORY


@given(key=keys(), value=tables())
def test_nested_keys_of_a_change_are_taken_or_refused_in_a_sentence(tmp_path_factory, key, value):
    path = scene_written(tmp_path_factory.mktemp("scene"))
    try:
        load_scenario(path, [f"{key}={value}"])
    except InputError as error:
        sentence = str(error)
        assert len(sentence) <= LONGEST
        assert "\n" not in sentence


@pytest.mark.parametrize("part", [r'"\""', r'"\\"', r"'\'", r'"\"."'])
def test_a_key_of_quoted_parts_is_counted_as_one_of_plain_parts(tmp_path, part):
    path = tmp_path / "escaped.toml"
    path.write_text(f"{'.'.join([part] * 1200)} = 1\n")
    with pytest.raises(InputError, match=r"line 1: a key has more than 10 parts"):
        load_scenario(path)
    change = f"gravity={{{'.'.join([part] * 1200)} = 1}}"
    with pytest.raises(InputError, match="gravity"):
        load_scenario("sphere_spin", [change])


def test_a_value_of_python_may_be_nested_as_deep_as_tables_are():
    deep = 1.0
    for _ in range(900):
        deep = [deep]
    with pytest.raises(InputError, match=r"gravity: .*nested") as refused:
        load_scenario("sphere_spin", {"gravity": deep})
    assert len(str(refused.value)) < LONGEST
