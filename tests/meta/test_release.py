"""The release command knows every committed result, and says how each differs from its commit."""

import re
import tomllib
from pathlib import Path

import pytest
import yaml

from quasistatic_ref import __version__
from validation.tools.release import RESULTS

ROOT = Path(__file__).parents[2]
# Written by a person who judged what was found, not by a command.
BY_HAND = {"validation/results/mutation_survivors.md", "validation/results/ports.md"}


def results():
    folders = ("validation/results/*", "validation/results/figures/*.png", "docs/figures/*")
    folders = (*folders, "validation/results/benchmarks/*")
    return {str(p.relative_to(ROOT)) for folder in folders for p in ROOT.glob(folder)}


def test_every_committed_result_has_a_command():
    written = [path for result in RESULTS for path in result.writes]
    orphans = {name for name in results() - BY_HAND if not any(name.startswith(w) for w in written)}
    assert orphans == set()
    assert len(results()) > 15


def test_the_table_of_validation_names_every_file_and_no_other():
    page = (ROOT / "validation" / "README.md").read_text("utf-8")
    files = [p for folder in ("make", "tools") for p in (ROOT / "validation" / folder).glob("*.py")]
    stems = {path.stem for path in files if path.stem != "__init__"}
    rows = page[page.index("| `make/NAME.py`") : page.index("| `results/`")]
    assert set(re.findall(r"`(\w+)`", rows)) == stems


def test_the_version_is_the_same_wherever_it_is_said():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    changelog = (ROOT / "docs" / "changelog.md").read_text("utf-8")
    assert project["version"] == citation["version"] == __version__
    assert __version__ in changelog


@pytest.mark.parametrize("folder", [".", "validation/vectors"])
def test_a_citation_has_the_place_of_a_doi(folder):
    text = (ROOT / folder / "CITATION.cff").read_text("utf-8")
    filled = yaml.safe_load(re.sub(r"^# (?=identifiers:|  )", "", text, flags=re.MULTILINE))
    (identifier,) = filled["identifiers"]
    assert identifier["type"] == "doi"
    # As the schema of CFF 1.2.0 wants it.
    assert re.fullmatch(r"10\.\d{4,9}(\.\d+)?/[A-Za-z0-9:/_;\-.()\[\]\\]+", identifier["value"])
