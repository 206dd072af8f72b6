"""The checker of the built site finds what it is there for."""

import pytest

from validation.tools.check_site import ROOT, equation_faults, markdown_faults, site_faults

GOOD = """<html><head><link rel="stylesheet" href="_static/a.css">
<script src="_static/a.js"></script>
</head><body><h1 id="top">x</h1><a href="#top">a</a><a href="b.html#there">b</a>
<a href="https://example.org">outside</a><img src="_static/p.png"></body></html>"""
OTHER = '<html><body><h1 id="there">y</h1><a href="index.html">home</a></body></html>'


def site(tmp_path, **files):
    (tmp_path / "_static").mkdir()
    texts = {"index.html": GOOD, "b.html": OTHER, "_static/p.png": "", "_static/a.js": ""}
    texts |= {"_static/a.css": "p { background: url(p.png) }"}
    for name, text in (texts | files).items():
        (tmp_path / name).write_text(text)
    return tmp_path


def test_a_good_site_has_no_fault(tmp_path):
    assert list(site_faults(site(tmp_path))) == []


PLANTED = {
    "a page that is not there": ("b.html", "c.html", "c.html#there, which is not there"),
    "a place that is not there": ("#there", "#nowhere", "a place that the page does not have"),
    "a place in the same page": ("#top", "#bottom", "a place that the page does not have"),
    "a picture that is not there": ("p.png", "q.png", "loads _static/q.png, which is not there"),
    "a script of a CDN": ("_static/a.js", "https://cdn.org/a.js", "loads https://cdn.org/a.js"),
    "a style of a CDN": ("_static/a.css", "//cdn.org/a.css", "loads //cdn.org/a.css"),
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


@pytest.mark.parametrize(("old", "new", "said"), PLANTED.values(), ids=PLANTED)
def test_a_planted_fault_is_found(tmp_path, old, new, said):
    faults = list(site_faults(site(tmp_path, **{"index.html": GOOD.replace(old, new, 1)})))
    assert len(faults) == 1
    assert said in faults[0]


def test_a_font_of_a_style_sheet_from_elsewhere_is_found(tmp_path):
    style = "@font-face { src: url('https://fonts.org/f.woff') }"
    (fault,) = site_faults(site(tmp_path, **{"_static/a.css": style}))
    assert fault == "_static/a.css loads https://fonts.org/f.woff"


def test_an_empty_folder_is_no_site(tmp_path):
    (fault,) = site_faults(tmp_path)
    assert "holds no page" in fault


def test_every_relative_link_of_the_repository_s_markdown_leads_to_a_file():
    assert list(markdown_faults(ROOT)) == []


def test_a_link_in_markdown_that_leads_nowhere_is_found(tmp_path):
    (tmp_path / "README.md").write_text("[a](gone.md#x)\n```\n[b](also.md)\n```\n[c](#here)\n")
    assert list(markdown_faults(tmp_path)) == ["README.md links to gone.md#x, which is not there"]


def numbered(pairs):
    one = '<div class="math" id="equation-eq-{}">\n<span class="eqno">({})<a></a></span></div>'
    return "".join(one.format(*pair) for pair in pairs)


def test_equations_numbered_as_in_the_paper_have_no_fault():
    assert list(equation_faults(numbered((n, n) for n in range(1, 14)))) == []


@pytest.mark.parametrize(
    "pairs",
    [
        [(n, n) for n in range(1, 13)],
        [(n, n + 1) for n in range(1, 14)],
        [(n, n) for n in (2, 1, *range(3, 14))],
    ],
)
def test_an_equation_that_is_missing_shifted_or_out_of_order_is_found(pairs):
    assert len(list(equation_faults(numbered(pairs)))) == 1
