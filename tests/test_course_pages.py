"""Each page of the course runs as its first lecture says, by ``python -m doctest`` alone."""

import pytest

from tests.pages import ROOT
from tests.processes import python

PAGES = sorted(path.name for path in (ROOT / "docs" / "course").glob("*.md"))


@pytest.mark.long
@pytest.mark.parametrize("page", PAGES)
def test_a_page_of_the_course_needs_no_names_of_the_site(page):
    python("-m", "doctest", ROOT / "docs" / "course" / page)
