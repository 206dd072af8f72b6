"""The checker of the built site finds what it is there for; every relative link of ours holds."""

import ast
import re
from textwrap import dedent

from tests.meta.remedies import assert_alike
from validation.tools.check_site import ROOT, markdown_faults


def test_every_relative_link_of_the_repository_s_markdown_leads_to_a_file(tmp_path):
    assert list(markdown_faults(ROOT)) == []
    (tmp_path / "README.md").write_text("[a](gone.md#x)\n```\n[b](also.md)\n```\n[c](#here)\n")
    assert list(markdown_faults(tmp_path)) == ["README.md links to gone.md#x, which is not there"]


ROLE = re.compile(r"\{[\w:]+\}`[^`]*`|^:::|^\(.*\)=$", re.MULTILINE)
"""Marks of MyST in prose, which a code host shows as they are."""


def test_pages_are_plain_markdown_on_a_code_host():
    pages = [path for path in ROOT.glob("docs/**/*.md") if "included" not in path.parts]
    raw = [f"{p.name} has {role}" for p in pages for role in ROLE.findall(p.read_text("utf-8"))]
    words = "{}: write a link or Eq. (N), which docs/conf.py makes a role for the site"
    assert_alike(raw, (), words)


PYTHON = re.compile(
    r"^( *)```(?:\{code-block\} )?python\n(?:\1:.*\n)*(.*?)^\1```", re.MULTILINE | re.DOTALL
)


def test_every_python_fence_of_our_pages_parses():
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    fences = [fence for page in pages for _, fence in PYTHON.findall(page.read_text("utf-8"))]
    for fence in fences:
        ast.parse(dedent(fence))
    assert len(fences) > 5
