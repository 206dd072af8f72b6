"""Deep keys and values of a scenario are refused in a sentence."""

import pytest

from quasistatic_ref import InputError, load_scenario

LONGEST = 2000
"""Most characters of a sentence."""


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
