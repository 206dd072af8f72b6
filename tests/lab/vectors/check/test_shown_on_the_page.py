"""What the guide shows of a check is what the check says."""

from tests.lab.vectors.committed_cases import answer_file, cases, plain_answer
from tests.pages import ROOT, flat, printed_blocks

PAGE = ROOT / "docs" / "guides" / "check_your_implementation.md"


def test_a_runner_that_forgets_h_is_answered_as_the_page_shows(tmp_path, cli):
    for layer, change in (("rows", {}), ("wrench", {"h": 1.0})):
        outputs = {c.id: plain_answer(layer, c.input | change) for c in cases(layer)}
        answer_file(tmp_path, layer, outputs, implementation="mine")
    answer = cli("vectors check", tmp_path, "--layer rows --layer wrench", status=1)
    (shown,) = printed_blocks(PAGE.read_text("utf-8"))
    assert flat(answer.out + answer.err) == flat(shown)
