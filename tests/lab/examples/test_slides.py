"""Slides of the two lectures: what stands on them is in the course."""

import re
from pathlib import Path

import pytest

from quasistatic_ref.lab.examples.gallery import EXAMPLES
from validation.tools import slides

COURSE = Path(__file__).parents[3] / "docs" / "course"
DECIMAL = re.compile(r"\d+\.\d+")
QUICK = ("contact_geometry",)
"""A figure that takes no time; `python -m validation.tools.slides` draws all."""


def first_slides(name):
    return [one for one in slides.slides(name) if one.get("figure") in (None, *QUICK)][:4]


@pytest.mark.parametrize("name", slides.SETS)
def test_slides_are_shown_in_order_in_75_minutes_and_their_figures_exist(name):
    shown = slides.slides(name)
    minutes = [slide["minute"] for slide in shown]
    assert minutes[0] == 0
    assert minutes == sorted(set(minutes))
    assert minutes[-1] < 75
    figures = [slide["figure"] for slide in shown if "figure" in slide]
    assert set(figures) <= {*EXAMPLES, *slides.DRAWINGS}
    assert len(figures) >= 5


@pytest.mark.parametrize("name", slides.SETS)
def test_every_decimal_number_of_a_slide_stands_in_the_course(name):
    pages = "".join(path.read_text("utf-8") for path in COURSE.glob("*.md"))
    shown = " ".join(" ".join([s["title"], *s["text"]]) for s in slides.slides(name))
    there = DECIMAL.findall(pages)
    for number in DECIMAL.findall(shown):  # with as many digits, or more
        assert any(one.startswith(number) for one in there), number


@pytest.mark.parametrize("name", slides.SETS)
def test_slides_are_one_page_each_of_a_pdf(name, tmp_path, monkeypatch):
    shown = first_slides(name)
    monkeypatch.setattr(slides, "slides", lambda name: shown)
    slides.write_slides(name, tmp_path)
    content = (tmp_path / f"lecture_{name}.pdf").read_bytes()
    assert content.count(b"/MediaBox") == len(shown)
