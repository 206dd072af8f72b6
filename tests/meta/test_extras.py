"""What needs an extra is marked with it."""

import re
import tomllib

import pytest

from tests.extras import is_missing
from tests.pages import ROOT
from tests.processes import python

EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"][
    "optional-dependencies"
]
SKIPS = re.compile(
    r"pytest\.skip\((?!.*--count)|mark\.skip|collect_ignore|importorskip\((?!.*reason=needs\()"
)
CONFTEST = """
from tests import conftest
from tests.conftest import *

conftest.is_missing = lambda extra: extra == "robots"
"""
"""The hooks of this suite, where one extra is missing."""
MARKED = """
import pytest

@pytest.mark.extra("robots")
@pytest.mark.parametrize("k", [1, 2])
def test_that_needs_it(k):
    pass

@pytest.mark.extra("fast")
def test_that_has_what_it_needs():
    pass
"""


def test_nothing_is_skipped_but_for_want_of_an_extra_or_of_a_count():
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
    assert {extra for (extra,) in marks} <= EXTRAS.keys() | {"fast"}  # compiled steps
    with pytest.raises(AssertionError, match="declares no extra nonsense"):
        is_missing("nonsense")


def test_what_is_skipped_is_named_with_its_extra(tmp_path):
    (tmp_path / "conftest.py").write_text(CONFTEST, "utf-8")
    (tmp_path / "test_marked.py").write_text(MARKED, "utf-8")
    options = "-q", "-rs", "-p", "no:cacheprovider", f"--rootdir={tmp_path}"
    printed = python("-m", "pytest", *options, tmp_path).stdout
    assert "1 passed, 2 skipped" in printed
    assert 'needs the extra robots: pip install -e ".[test,robots]"' in printed
