"""What needs an extra is marked with it."""

import re
import tomllib

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


def test_a_skipped_test_is_named_with_its_extra_and_left_to_ci(request, monkeypatch):
    monkeypatch.setattr(conftest, "is_missing", lambda extra: extra == "robots")
    items = []
    for extra in ("robots", "engines", "compiled"):
        item = pytest.Function.from_parent(request.node.parent, name=extra, callobj=lambda: None)
        item.add_marker(pytest.mark.extra(extra))
        items.append(item)
    conftest.pytest_collection_modifyitems(items)
    reasons = [mark.kwargs["reason"] for item in items for mark in item.iter_markers("skip")]
    assert reasons == ['needs the extra robots: pip install -e ".[test,robots]"']
    assert [item.name for item in items if item.get_closest_marker("ci")] == ["robots"]
