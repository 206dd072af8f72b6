"""``quasistatic-ref stands``: a row a body, over the steps of a run."""

import json

import pytest

import quasistatic_ref as qr

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


def test_a_scene_whose_first_step_is_refused_is_not_said_to_have_nothing_free(cli):
    # An edge of the middle box is 10 mm deep in an edge of the lower one, along x and along z.
    pose = "bodies.middle.pose={xyz=[0.08,0,0.13],rpy=[0,0,0]}"
    told = cli(f"stands stack --set {pose} {FAST}", status=3)
    assert told.out == "no step has ended\n"
    assert "as deep in each other along [1., 0., 0.] as along [0., 0., 1.]" in told.err


@pytest.mark.parametrize(
    ("scene", "at", "steps"), [("block_incline", 0.5, 50), ("stack", 0.01, 1), ("stack", 0.5, 50)]
)
def test_a_run_ends_where_it_is_asked(cli, monkeypatch, scene, at, steps):
    """After T = k h no step is taken: k steps in all, 50 in 0.5 s of 0.01 s each."""
    taken = []
    run = qr.Scenario.run
    monkeypatch.setattr(
        qr.Scenario, "run", lambda self, **words: taken.append(run(self, **words)) or taken[0]
    )
    whole = qr.load_scenario(scene, fast=True).run(progress=False)
    del taken[:]
    record = json.loads(cli(f"stands {scene} --at {at} --json {FAST}").out)
    assert [run.steps for run in taken] == [steps]
    assert record["steps"] == [steps - 1]
    standings = whole.stands(steps - 1)
    assert [row["stands"] for row in record["bodies"]] == [row.stands for row in standings]


@pytest.mark.parametrize("at", ["nan", "inf", "-1", "0"])
def test_a_time_at_which_no_step_ends_is_refused(cli, at):
    told = cli(f"stands stack --at {at} {FAST}", status=2)
    assert "--at: must be the end of a step, up to 0.5 s" in told.err
