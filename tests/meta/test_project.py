"""What pyproject.toml says of the project agrees with what is said elsewhere."""

import re
import tomllib

import yaml

from quasistatic_ref import __version__
from tests.meta.remedies import assert_among
from tests.pages import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]


def test_the_version_is_the_same_wherever_it_is_said():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert PROJECT["version"] == citation["version"] == __version__


def test_every_extra_is_on_the_page_that_installs_the_package():
    page = (ROOT / "docs" / "quickstart.md").read_text("utf-8")
    cells = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \|", page, re.MULTILINE)
    words = "The extra {} is not in the table of docs/quickstart.md: add a row"
    assert_among(EXTRAS, re.findall(r"\w+", " ".join(cells)), words)


def test_the_extra_all_is_every_extra_for_use():
    (line,) = EXTRAS["all"]
    names = {*re.search(r"\[(.*)\]", line)[1].split(",")}
    words = (
        "The extra {} is not in all: add it to all in pyproject.toml, or to the four that are not"
    )
    assert_among(EXTRAS, names | {"all", "compared", "test", "docs"}, words)


def test_every_extra_for_use_is_in_the_extra_test_or_a_marker():
    marked = {
        word
        for path in ROOT.glob("tests/**/*.py")
        for call in re.findall(r"\bextra\((.*)\)", path.read_text("utf-8"))
        for word in re.findall(r'"(\w+)"', call)
    }
    packages = {name: {re.match(r"[\w.-]+", one)[0] for one in EXTRAS[name]} for name in EXTRAS}
    words = (
        "Nothing tests the extra {}: add its packages to the extra test of pyproject.toml, or "
        'pytest.mark.extra("{}") to the tests that need it'
    )
    for_use = EXTRAS.keys() - {"all", "compared", "test", "docs"}
    tested = {name for name in for_use if packages[name] <= packages["test"]}
    assert_among(for_use, tested | marked, words)
