"""What needs an extra is marked with it."""

import ast
import re
import sys
import tomllib
from types import SimpleNamespace

import pytest

from tests import conftest
from tests.extras import is_missing
from tests.pages import PACKAGE, ROOT

EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"][
    "optional-dependencies"
]
SKIPS = re.compile(
    r"pytest\.skip\((?!.*--count)|mark\.skip|collect_ignore|importorskip\((?!.*reason=needs\()"
)


def test_tests_are_skipped_for_want_of_an_extra_or_of_a_count_alone():
    sources = [path for path in ROOT.glob("tests/**/*.py") if path.name != "test_extras.py"]
    found = {path.name for path in sources if SKIPS.search(path.read_text("utf-8"))}
    assert found == {"conftest.py"}, "it skips by the marker"


def test_a_file_that_is_skipped_whole_has_the_marker_by_which_ci_takes_it():
    for path in ROOT.glob("tests/**/*.py"):
        source = path.read_text("utf-8")
        skipped = re.search(r"^\w+ = pytest\.importorskip\(", source, re.MULTILINE)
        marked = "pytestmark = pytest.mark.extra(" in source
        assert marked or not skipped, f"write pytestmark = pytest.mark.extra(...) in {path}"


def test_every_marker_names_an_extra(request):
    marks = [mark.args for item in request.session.items for mark in item.iter_markers("extra")]
    assert {extra for (extra,) in marks} <= EXTRAS.keys() | {"compiled"}
    with pytest.raises(AssertionError, match="declares no extra nonsense"):
        is_missing("nonsense")


OTHER_NAMES = {"pin": "pinocchio", "python-flint": "flint", "cffi": "_cffi_backend"}
ALONE = {"optional/mujoco/compilation.py"}
"""Programs of a process of their own, which is started where the extra is there."""


def test_no_module_imports_a_package_of_an_extra_at_its_top():
    """What a plain install lacks is imported where it is used, by ``needed_package``."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    required = {re.match(r"[\w-]+", one)[0] for one in project["dependencies"]}
    plain = {OTHER_NAMES.get(name, name).lower() for name in required} | sys.stdlib_module_names
    late = []
    for path in sorted(PACKAGE.rglob("*.py")):
        file = path.relative_to(PACKAGE).as_posix()
        for node in ast.parse(path.read_text("utf-8")).body:
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module] if isinstance(node, ast.ImportFrom) and not node.level else []
            packages = {name.partition(".")[0].lower() for name in names}
            if file not in ALONE and packages - plain - {"quasistatic_ref"}:
                late.append(f"{file} imports {', '.join(names)} at its top: import it where used")
    assert late == []


def idle_tests(request, names):
    """Tests that do nothing."""
    parent = request.node.parent
    return [pytest.Function.from_parent(parent, name=n, callobj=lambda: None) for n in names]


def taken(request, indices, share, path="tests", marks=("shared",)):
    """The cases of a test that one of the lines takes, by their indices, and what `extras` does."""
    items = idle_tests(request, [f"test{list(each.values())}" for each in indices])
    for item, each in zip(items, indices, strict=True):
        item.callspec = SimpleNamespace(indices=each)
        for mark in marks:
            item.add_marker(mark)
    config = SimpleNamespace(args=[path], getoption={"--share": share}.get)
    conftest.pytest_collection_modifyitems(config, items)
    line = {item.name for item in items if not item.get_closest_marker("long")}
    return line, {item.name for item in items if item.get_closest_marker("ci")}


def test_three_lines_share_the_cases_of_a_slow_test(request):
    indices = [{"what": k, "value": k} for k in range(10)]  # columns of one table
    (readme, extras), (lowest, same) = (taken(request, indices, share) for share in (0, 1))
    assert [len(one) for one in (readme, lowest, extras)] == [4, 3, 3]
    assert len(readme | lowest | extras) == len(indices)
    assert extras == same


def test_each_line_takes_each_value_of_each_parameter(request):
    indices = [{"one": i, "other": k} for i in range(3) for k in range(6)]
    lines = [taken(request, indices, share)[0] for share in range(3)]
    assert set.union(*lines) == {f"test[{i}, {k}]" for i in range(3) for k in range(6)}
    for line in lines:
        assert {name[5] for name in line} == set("012")
        assert {name[8] for name in line} == set("012345")
        assert len(line) < len(indices)


@pytest.mark.parametrize(
    ("path", "marks"), [("tests/step", ["shared"]), ("tests", []), ("test_step.py", ["shared"])]
)
def test_cases_are_not_shared_where_a_path_is_named_or_a_test_is_fast(request, path, marks):
    indices = [{"row": k} for k in range(9)]
    line, extras = taken(request, indices, 0, path, marks)
    assert len(line) == len(indices)
    assert extras == set()


def test_a_skipped_test_is_named_with_its_extra_and_left_to_ci(request, monkeypatch):
    monkeypatch.setattr(conftest, "is_missing", lambda extra: extra == "robots")
    items = idle_tests(request, ["robots", "engines", "compiled"])
    for item in items:
        item.add_marker(pytest.mark.extra(item.name))
    conftest.pytest_collection_modifyitems(request.config, items)
    reasons = [mark.kwargs["reason"] for item in items for mark in item.iter_markers("skip")]
    assert reasons == ['needs the extra robots: pip install -e ".[test,robots]"']
    assert [item.name for item in items if item.get_closest_marker("ci")] == ["robots"]
