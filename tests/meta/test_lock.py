"""The lock file of development has every dependency that is declared, at a version that will do."""

import re
import tomllib
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[2]
LOCK = ROOT / ".ci" / "lock.txt"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


def locked_versions():
    """Package -> its versions: where Pythons or systems need different ones, several."""
    found = {}
    for line in LOCK.read_text("utf-8").splitlines():
        if not line.startswith("#"):
            one = Requirement(line)
            (pin,) = one.specifier
            assert pin.operator == "=="
            found.setdefault(canonicalize_name(one.name), []).append(pin.version)
    return found


def test_every_declared_dependency_is_locked_at_versions_that_it_admits():
    found = locked_versions()
    lists = [PROJECT["dependencies"], *PROJECT["optional-dependencies"].values()]
    declared = [Requirement(line) for one in lists for line in one]
    others = [one for one in declared if one.name != PROJECT["name"]]
    assert len(others) > len(PROJECT["dependencies"]) > 10
    for one in others:
        versions = found.get(canonicalize_name(one.name), [])
        assert versions, f"{one.name} is not locked: {command()}"
        assert all(one.specifier.contains(version) for version in versions), one


def command():
    """The command that its head says it was made by."""
    return re.search(r"^# +(uv pip compile .*)$", LOCK.read_text("utf-8"), re.MULTILINE)[1]
