"""The sdist has everything, and the program that checks an sdist notices what lacks."""

import re
import tomllib
from pathlib import Path

from validation.tools.check_sdist import TESTS

ROOT = Path(__file__).parents[2]
TARGETS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["hatch"]["build"]
ALWAYS = {"pyproject.toml", ".gitignore"}  # always taken by hatchling
READ = re.compile(r"\bROOT / \"([\w.]+)\"")


def test_the_sdist_takes_all_that_the_tests_read():
    taken = {name.removeprefix("/") for name in TARGETS["targets"]["sdist"]["include"]}
    assert [name for name in taken if not (ROOT / name).exists()] == []
    sources = [path.read_text("utf-8") for path in (ROOT / "tests").rglob("*.py")]
    read = {name for text in sources for name in READ.findall(text) if (ROOT / name).exists()}
    assert {"docs", "models", "validation", "quasistatic_ref", ".ci", "README.md"} <= read
    assert read | {"tests", "LICENSE"} <= taken | ALWAYS


def test_the_tests_that_run_in_an_sdist_exist():
    assert [name for name in TESTS if not (ROOT / name).exists()] == []
