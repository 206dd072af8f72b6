"""A student's task, from one contact to the multipliers of a stick, by its page's blocks alone.

The roboticist's is tests/meta/test_first_scene.py, the solver author's
tests/lab/study/test_a_solver_of_your_own.py.
"""

import doctest
import re

import numpy as np

from tests.pages import ROOT

BLOCK = re.compile(r"^```\{doctest\}\n(.*?)^```", re.MULTILINE | re.DOTALL)


def test_the_blocks_of_one_contact_run_in_an_empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "course" / "one_contact.md").read_text("utf-8")
    blocks = "\n".join(BLOCK.findall(page))
    assert ".lam" in blocks
    test = doctest.DocTestParser().get_doctest(blocks, {}, "one_contact", None, 0)
    with np.printoptions():
        runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
        outcome = runner.run(test)
    assert outcome.failed == 0
    assert outcome.attempted > 10
    assert not any(tmp_path.iterdir())
