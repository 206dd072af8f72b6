"""The checker of the built site finds what it is there for; every relative link of ours holds."""

import ast
import re
from textwrap import dedent

import pytest

from validation.tools.check_site import ROOT, equation_faults, markdown_faults, site_faults

GOOD = """<html><head><link rel="stylesheet" href="_static/a.css">
<script src="_static/a.js"></script>
</head><body><h1 id="top">x</h1><a href="#top">a</a><a href="b.html#there">b</a>
<a href="https://example.org">outside</a><img src="_static/p.png"></body></html>"""
PLANTED = {
    "a page that is not there": ("b.html", "c.html", "c.html#there, which is not there"),
    "a place that is not there": ("#there", "#nowhere", "a place that the page does not have"),
    "a picture that is not there": ("p.png", "q.png", "loads _static/q.png, which is not there"),
    "a script of a CDN": ("_static/a.js", "https://cdn.org/a.js", "loads https://cdn.org/a.js"),
    "a style in the page": (
        "</head>", "<style>@import 'https://fonts.org/f.css'</style></head>", "fonts.org",
    ),
    "a script in the page": (
        "</head>", "<script>import('https://cdn.org/m.js')</script></head>", "cdn.org/m.js",
    ),
    "a picture twice": (
        "</body>", '<img src="_static/p.png"></body>', "shows _static/p.png 2 times",
    ),
}  # fmt: skip


def faults(folder, page=GOOD):
    """What the checker finds in a site whose first page is this."""
    (folder / "_static").mkdir(exist_ok=True)
    (folder / "index.html").write_text(page)
    (folder / "b.html").write_text('<h1 id="there">y</h1><a href="index.html">home</a>')
    (folder / "_static" / "a.css").write_text("p { background: url(p.png) }")
    for name in ("p.png", "a.js"):
        (folder / "_static" / name).write_text("")
    return list(site_faults(folder))


def test_a_good_site_has_no_fault_and_an_empty_folder_is_no_site(tmp_path):
    assert "holds no page" in next(site_faults(tmp_path))
    assert faults(tmp_path) == []


@pytest.mark.parametrize(("old", "new", "said"), PLANTED.values(), ids=PLANTED)
def test_a_planted_fault_is_found(tmp_path, old, new, said):
    (found,) = faults(tmp_path, GOOD.replace(old, new, 1))
    assert said in found


def test_every_relative_link_of_the_repository_s_markdown_leads_to_a_file(tmp_path):
    assert list(markdown_faults(ROOT)) == []
    (tmp_path / "README.md").write_text("[a](gone.md#x)\n```\n[b](also.md)\n```\n[c](#here)\n")
    assert list(markdown_faults(tmp_path)) == ["README.md links to gone.md#x, which is not there"]


PYTHON = re.compile(
    r"^( *)```(?:\{code-block\} )?python\n(?:\1:.*\n)*(.*?)^\1```", re.MULTILINE | re.DOTALL
)


def test_every_python_fence_of_our_pages_parses():
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    fences = [fence for page in pages for _, fence in PYTHON.findall(page.read_text("utf-8"))]
    for fence in fences:
        ast.parse(dedent(fence))
    assert len(fences) > 15


@pytest.mark.parametrize(
    ("numbers", "count"), [(range(1, 14), 0), (range(1, 13), 1), ((2, 1, *range(3, 14)), 1)]
)
def test_equations_are_numbered_as_in_the_paper(numbers, count):
    one = '<div class="math" id="equation-eq-{0}">\n<span class="eqno">({0})<a></a></span></div>'
    assert len(list(equation_faults("".join(map(one.format, numbers))))) == count
