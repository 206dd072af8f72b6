"""What the README shows is what runs: its example, and its command for the tests."""

import re
from pathlib import Path

import numpy as np

from tests.quoted import printed_blocks
from validation.tools.installs import shell_lines

ROOT = Path(__file__).parents[2]


def test_the_example_prints_what_the_readme_shows(capsys):
    text = (ROOT / "README.md").read_text("utf-8")
    (example,) = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    exec(compile(example, "README.md", "exec"), {})
    shown = [line.rsplit(maxsplit=1) for line in printed_blocks(text)[0].splitlines()]
    found = [line.rsplit(maxsplit=1) for line in capsys.readouterr().out.splitlines()]
    assert [answer for answer, _ in found] == [answer for answer, _ in shown]
    # A solver's own digits depend on the instructions of the processor.
    digits = [[int(own) for _, own in lines] for lines in (found, shown)]
    assert np.abs(np.subtract(*digits)).max() <= 1


def test_ci_runs_the_line_for_the_tests_as_it_is_printed():
    (line,) = (c for c in shell_lines((ROOT / "README.md").read_text("utf-8")) if "pytest" in c)
    pattern = re.search(r"grep -E '(.*)' README\.md", (ROOT / ".ci" / "run").read_text("utf-8"))[1]
    found = [one for one in (ROOT / "README.md").read_text("utf-8").splitlines()
             if re.search(pattern, one)]  # fmt: skip
    assert found == [line]
