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
