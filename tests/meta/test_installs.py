"""Every extra has commands that prove it, and its line in the guide."""

import re
import tomllib
from pathlib import Path

from validation.tools.installs import COMMANDS, REFUSED

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]


def test_every_extra_has_commands_and_a_line_in_the_guide():
    assert {*COMMANDS} == {"base", *EXTRAS}
    guide = (ROOT / "docs" / "guides" / "install.md").read_text("utf-8")
    guide = guide[: guide.index("## The commands")]
    assert {*re.findall(r"^\| `(\w+)` \|", guide, re.MULTILINE)} == {*EXTRAS}


def measured():
    """Extra -> its size [MB] and largest packages, with Python 3.11 and the newest versions."""
    page = (ROOT / "validation" / "results" / "installs.md").read_text("utf-8")
    rows = [line.strip("| ").split(" | ") for line in page.splitlines() if "| newest |" in line]
    rows = [row for row in rows if row[1].startswith("3.11.")]
    return {row[0]: (row[3], dict(PART.findall(row[4]))) for row in rows}


PART = re.compile(r"(\S+) (\d+)(?:,|$)")
ADDED = {"example-robot-data": "robots", "pyarrow": "study"}


def test_the_sizes_in_the_guide_are_those_that_were_measured():
    found = measured()
    guide = (ROOT / "docs" / "guides" / "install.md").read_text("utf-8")
    gigabytes = {extra: f"{int(size) / 1024:.1f}" for extra, (size, _) in found.items()}
    said = dict(re.findall(r"^\| `(\w+)` \|[^|]*\| ([^|]*) \|", guide, re.MULTILINE))
    said = {extra: size for extra, size in said.items() if size != "not measured"}
    assert said == {extra: size for extra, size in gigabytes.items() if extra != "base"}
    assert gigabytes["base"] == "1.0"  # a gigabyte
    assert dict(re.findall(r"^\| ([\w-]+) \| (\d+) \|", guide, re.MULTILINE)) == found["base"][1]
    added = re.search(r"the robots (\d+) .*PyArrow (\d+)", guide)
    assert [*added.groups()] == [found[extra][1][name] for name, extra in ADDED.items()]


def test_an_extra_that_a_refusal_names_exists():
    named = {
        re.search(r"\[(\w+)\]", text)[1] for lines in REFUSED.values() for text in lines.values()
    }
    assert named <= {*EXTRAS}
    assert len(named) > 3


def test_all_is_every_extra_for_use():
    (said,) = EXTRAS["all"]
    found = {*re.search(r"\[(.*)\]", said)[1].split(",")}
    assert {*EXTRAS} - found == {"all", "test", "docs", "fuzz", "node"}
