"""The sdist has everything that the tests read."""

import re
import tomllib
from pathlib import Path

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
