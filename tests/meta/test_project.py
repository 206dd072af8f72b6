"""What pyproject.toml says of the project agrees with what is said elsewhere."""

import re
import tomllib

import yaml

from quasistatic_ref import __version__
from tests.pages import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]


def test_the_version_is_the_same_wherever_it_is_said():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert PROJECT["version"] == citation["version"] == __version__


def test_every_extra_has_a_line_in_the_guide():
    guide = (ROOT / "docs" / "guides" / "install.md").read_text("utf-8")
    assert {*re.findall(r"^\| `(\w+)` \|", guide, re.MULTILINE)} >= {*EXTRAS}


def test_all_is_every_extra_for_use():
    (line,) = EXTRAS["all"]
    names = {*re.search(r"\[(.*)\]", line)[1].split(",")}
    assert {*EXTRAS} - names == {"all", "compared", "test", "docs"}
