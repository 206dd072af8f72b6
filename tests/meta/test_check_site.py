"""The checker of the built site finds what it is there for; every relative link of ours holds."""

import ast
import re
from textwrap import dedent

from validation.tools.check_site import ROOT, markdown_faults


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
    assert len(fences) > 5
