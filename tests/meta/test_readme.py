"""What README shows is what runs: its example, its numbers, and its command for the tests."""

import json
import re

import numpy as np

from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.lab.figures.clouds import rotations_by_case
from tests.meta.remedies import assert_alike
from tests.pages import ROOT, fenced, flat, printed_blocks, shell_lines

README = (ROOT / "README.md").read_text("utf-8")
RESULTS = ROOT / "validation" / "results"


def test_the_example_prints_what_the_readme_shows(capsys):
    (example,) = fenced(README, "python")
    exec(compile(example, "README.md", "exec"), {})
    shown = [line.rsplit(maxsplit=1) for line in printed_blocks(README)[0].splitlines()]
    printed = [line.rsplit(maxsplit=1) for line in capsys.readouterr().out.splitlines()]
    assert [answer for answer, _ in printed] == [answer for answer, _ in shown]
    # A solver's own digits depend on the instructions of the processor.
    digits = [[int(last) for _, last in lines] for lines in (printed, shown)]
    assert np.abs(np.subtract(*digits)).max() <= 1


def test_the_numbers_of_the_readme_are_those_of_the_committed_results():
    claims = (RESULTS / "claims.md").read_text("utf-8")
    measured = dict(re.findall(r"^\| rotation (\w+) torsion \[deg\] \| 1 \| (\S+)", claims, re.M))
    angles = {case: float(angle) for case, angle in measured.items()}
    with_torsion, without = (turns <= 1 for turns in rotations_by_case().values())
    lines = (ROOT / "validation/contact_qp/problems.jsonl").read_text("utf-8").splitlines()
    problems = [json.loads(line) for line in lines]
    proved = [one["family"] for one in problems if one["answer"]["kind"] != "bounded"]
    assert not without.any()
    sentences = (
        f"the bunny turns by {angles['with']:.1f} degrees during the lift",
        f"Without it the bunny turns by {angles['without']:.1f} degrees",
        f"{len(without)} other point clouds of this bunny",
        f"With torsional friction {sum(with_torsion)} of them turn by at most one degree",
        f"Without it all {len(without)} turn by more",
        f"{len(proved):,} contact problems in {len({*proved})} families",
        f"tests [{len(BY_NAME)} claims]",
    )
    text = flat(README)
    wrong = [sentence for sentence in sentences if sentence not in text]
    assert_alike(wrong, (), 'README.md does not say "{}": change its number there')


def test_ci_runs_the_line_for_the_tests_as_it_is_printed():
    (line,) = (command for command in shell_lines(README) if "pytest" in command)
    pattern = re.search(r"grep -E '(.*)' README\.md", (ROOT / ".ci" / "run").read_text("utf-8"))[1]
    assert [one for one in README.splitlines() if re.search(pattern, one)] == [line]
