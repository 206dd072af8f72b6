"""Each page of docs/ is in the table of contents, with its question; facts are explained once."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGES = {str(path.relative_to(DOCS)): path.read_text("utf-8") for path in DOCS.rglob("*.md")}
ROW = re.compile(r"^- \[[^\]]*\]\(([^)]+)\): (.+\?)(?: \((\d+)\))?", re.MULTILINE)
MOST = 80_000
"""Words of all pages: fewer when pages get shorter, never more."""
MOST_OF_RESULTS = 63_000
"""The same of Markdown in validation/: what a program writes for programs is no Markdown."""

WHY = (
    r"from rest|\b(?:no|not|nothing|without|forgets?|loses?)\b[^.,]{0,40}(?:velocit|momentum)"
    r"|(?:velocit|momentum)[^.,]{0,30}\b(?:not|no|forgotten|dropped|lost|zero)\b"
)
EXPLAINED = {
    "the drag": (
        r"\bdrag\b|m ?v ?/ ?h\b|frac\{m ?v\}\{h\}", WHY,
        {"course/springs_and_steps.md"},
        "A body keeps no velocity between steps, so it needs the force $mv/h$.",
    ),
    "free fall": (
        r"h\^2 ?(?:\\,)?g", rf"{WHY}|physics says", {"derivations.md"},
        "It falls by h^2 g in each step, since the velocity of the last step is lost.",
    ),
    "80 rows": (
        r"\b80\b", r"[Tt]en .*six rows|10 x 6|10 contacts|90 rows|are 90", {"theory/errata.md"},
        "15 x 6 = 90 rows are too many: 10 contacts with six and 5 with four make 80.",
    ),
}  # fmt: skip
"""What: its formula, words that only an explanation needs, the page that explains it, and such a
sentence."""


def paragraphs(text):
    """Paragraphs and rows of tables, each in one line, without code."""
    prose = re.sub(r"^( *)```.*?^\1```", "", text, flags=re.MULTILINE | re.DOTALL)
    return [" ".join(one.split()) for one in re.split(r"\n\n|\n\|", prose)]


def test_every_page_has_one_row_with_a_question():
    rows = ROW.findall(PAGES["contents.md"])
    listed = [page for page, _, _ in rows]
    assert len(set(listed)) == len(listed)
    lists_of_modules = {page for page in PAGES if page.startswith("api/")} - {"api/index.md"}
    assert set(listed) == set(PAGES) - lists_of_modules
    questions = [question for _, question, _ in rows]
    assert len(set(questions)) == len(questions)
    words = {page: int(count) for page, _, count in rows if page != "contents.md"}
    assert words == {page: len(PAGES[page].split()) for page in words}


def test_the_pages_have_at_most_so_many_words():
    assert sum(len(text.split()) for text in PAGES.values()) <= MOST


def test_results_in_markdown_have_at_most_so_many_words():
    pages = (DOCS.parent / "validation").rglob("*.md")
    assert sum(len(path.read_text("utf-8").split()) for path in pages) <= MOST_OF_RESULTS


def explaining_paragraphs(what, text):
    """The paragraphs of a text that explain something."""
    formula, words, *_ = EXPLAINED[what]
    return [one for one in paragraphs(text) if re.search(formula, one) and re.search(words, one)]


@pytest.mark.parametrize("what", EXPLAINED)
def test_what_is_explained_is_explained_on_one_page(what):
    *_, home, sentence = EXPLAINED[what]
    assert {page for page, text in PAGES.items() if explaining_paragraphs(what, text)} == home
    assert explaining_paragraphs(what, f"Before.\n\n{sentence}\n\nAfter.") == [sentence]
