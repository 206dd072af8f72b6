"""What needs an extra is marked with it."""

import re
import tomllib
from types import SimpleNamespace

import pytest

from tests import conftest
from tests.extras import is_missing
from tests.pages import ROOT

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


def idle_tests(request, names):
    """Tests that do nothing."""
    parent = request.node.parent
    return [pytest.Function.from_parent(parent, name=n, callobj=lambda: None) for n in names]


@pytest.mark.parametrize("path", ["tests", "tests/step"])
def test_a_third_of_many_cases_is_taken_where_no_file_is_named(request, path):
    names = [
        f"{test}[{k}]" for k in range(9) for test in ("many", "few") if test == "many" or k < 6
    ]
    items = idle_tests(request, names)
    conftest.pytest_collection_modifyitems(SimpleNamespace(args=[path]), items)
    left = {item.name for item in items if item.get_closest_marker("ci")}
    assert left == ({f"many[{k}]" for k in (1, 2, 4, 5, 7, 8)} if path == "tests" else set())


def test_a_skipped_test_is_named_with_its_extra_and_left_to_ci(request, monkeypatch):
    monkeypatch.setattr(conftest, "is_missing", lambda extra: extra == "robots")
    items = idle_tests(request, ["robots", "engines", "compiled"])
    for item in items:
        item.add_marker(pytest.mark.extra(item.name))
    conftest.pytest_collection_modifyitems(request.config, items)
    reasons = [mark.kwargs["reason"] for item in items for mark in item.iter_markers("skip")]
    assert reasons == ['needs the extra robots: pip install -e ".[test,robots]"']
    assert [item.name for item in items if item.get_closest_marker("ci")] == ["robots"]
