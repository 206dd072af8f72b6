"""``quasistatic-ref stands``: a row a body, over the steps of a run."""

import json

import pytest

FAST = "--quiet --fast"


def test_a_row_a_body_with_the_step_since_which_it_lacks(cli):
    head, row = cli(f"stands sphere_spin --every 20 --strict {FAST}", status=1).out.splitlines()
    assert head.split()[:4] == ["body", "stands", "since", "step"]
    assert head.endswith("most missing, in the pyramid  at step")
    assert row.split() == ["sphere", "no,", "in", "8", "of", "10", "59", "0.1177", "N", "m", "199"]


def test_one_step_and_plain_data(cli):
    record = json.loads(cli(f"stands block_incline --at 0.5 --json {FAST}").out)
    assert (record["steps"], record["cone"]) == ([49], "pyramid")
    rough, smooth = record["bodies"]
    assert (rough["stands"], rough["since"]) == (True, None)
    assert (smooth["stands"], smooth["since"]) == (False, 49)
    assert smooth["missing_N"] == pytest.approx(0.7393, rel=1e-3)


@pytest.mark.parametrize(
    ("words", "status", "sentence"),
    [
        ("peg_in_hole --set steps=2", 0, "nothing in this scene is free"),
        ("stack --at 7", 2, "--at: must be the end of a step, up to 0.5 s"),
        ("stack --every 0", 2, "--every: must be at least 1"),
        ("stack --set steps=2 --certify residual", 2, "must be full or off"),
    ],
)
def test_bad_questions_and_scenes_without_free_bodies_are_told(cli, words, status, sentence):
    assert sentence in "".join(cli(f"stands {words} {FAST}", status=status))
