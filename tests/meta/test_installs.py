"""Every extra has commands that prove it, and its line in the guide."""

import re
import tomllib
from pathlib import Path

from validation.check_installs import largest, python_block, written
from validation.installs import COMMANDS, OWN, REFUSED, SCRIPTS

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]


def test_every_extra_but_that_of_the_tests_has_commands_and_a_line_in_the_guide():
    named = {*EXTRAS} - {"test"}  # whose command is the suite
    assert {*COMMANDS} == {"base", *named}
    guide = (ROOT / "docs" / "guides" / "install.md").read_text("utf-8")
    assert {*re.findall(r"^\| `(\w+)` \|", guide, re.MULTILINE)} == {*EXTRAS}


def test_an_extra_that_a_refusal_names_exists():
    named = {
        re.search(r"\[(\w+)\]", text)[1] for lines in REFUSED.values() for text in lines.values()
    }
    assert named <= {*EXTRAS}
    assert len(named) > 3


def test_all_is_every_extra_for_use():
    (said,) = EXTRAS["all"]
    found = {*re.search(r"\[(.*)\]", said)[1].split(",")}
    assert {*EXTRAS} - found == {"all", "test", "docs"}


def test_the_scripts_are_on_their_pages():
    for page, word in SCRIPTS.values():
        assert word in python_block(page, word)
    assert {"bunny_grasp", "door"} <= {*OWN}
    assert "panda_push" not in OWN  # its robot is in an extra


def test_a_table_keeps_the_lines_of_other_runs(tmp_path):
    page = tmp_path / "installs.md"
    cells = ["1000", "numpy 9", "10", "20", "3"]
    written(page, [["docs", "3.11.7", "newest", *cells, "good"]])
    written(page, [["base", "3.11.7", "newest", *cells, "1 fail"]])
    written(page, [["base", "3.12.1", "newest", *cells, "good"]])
    written(page, [["base", "3.11.7", "newest", *cells, "good"]])
    lines = [line for line in page.read_text("utf-8").splitlines() if line.startswith("| ")][1:]
    assert [line.split(" | ")[1] for line in lines] == ["3.11.7", "3.12.1", "3.11.7"]
    assert [line.split(" | ")[0] for line in lines] == ["| base", "| base", "| docs"]
    assert all(line.endswith("| good |") for line in lines)


def test_the_largest_parts_count_the_libraries_of_a_wheel(tmp_path):
    packages = tmp_path / "lib" / "python3.11" / "site-packages"
    for name, size in (("one", 1), ("two", 2), ("one.libs", 3)):
        (packages / name).mkdir(parents=True)
        (packages / name / "file").write_bytes(b"x" * (size << 20))
    assert largest(tmp_path) == "one 4, two 2"
