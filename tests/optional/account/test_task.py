"""A sample of validation/make/mistakes.py, and of each finding the near miss that is none."""

import pytest

from validation.make.mistakes import SCENES, findings_after, healthy_scenes, is_named, mistakes

SAMPLE = (
    "steps = 0, a push",
    "no targets for the pusher",
    "h = 1e-4, a push",
    "no table of contacts for the push",
    "the pusher stops 8 mm before the box",
    "no friction in the grip",
    "the pusher is too soft to move the box",
    "the box's centre of mass 20 cm outside of it",
    "no table of contacts for box and table",
)
NEAR_MISSES = {
    "a trial of the first steps": ("push", [["push.toml", "steps = 120", "steps = 12"]]),
    "a pusher that just touches": ("push", [["push.toml", "slide = 0.08", "slide = 0.0201"]]),
    # It bears m g + m v / h = 3.43 + 0.7 N with mu_v 20 N; its weight and 1700 N/m are 2 mm of 30.
    "a grip that just bears, on a soft lift": (
        "grasp",
        [
            ["grasp.toml", "mu_v = 0.6", "mu_v = 0.215"],
            ["grasp.toml", "lift = 5000", "lift = 1700"],
        ],
    ),
    "a can 0.3 mm in the air": ("grasp", [["grasp.toml", "0.0601", "0.0603"]]),
    "rubber": ("push", [["push.toml", "mu_v = 0.2", "mu_v = 1.5"]]),
}


@pytest.mark.parametrize("what", SAMPLE)
def test_a_mistake_is_named_in_the_first_sentence(what):
    (mistake,) = [one for one in mistakes() if one["what"] == what]
    findings = findings_after(mistake["scene"], mistake["edits"])
    assert is_named(mistake, findings), [str(one) for one in findings]


@pytest.mark.parametrize("scene", SCENES[:2])
def test_a_scene_without_a_mistake_has_no_finding(scene):
    assert findings_after(scene) == ()


@pytest.mark.parametrize("one", healthy_scenes()[1:24:6], ids=lambda one: one["what"])
def test_a_scene_without_a_mistake_has_no_grave_finding_however_it_is_made(one):
    assert [str(x) for x in findings_after(one["scene"], one["edits"]) if x.grave] == []


@pytest.mark.parametrize("what", NEAR_MISSES)
def test_a_near_miss_has_no_finding_that_is_grave(what):
    scene, edits = NEAR_MISSES[what]
    assert [str(one) for one in findings_after(scene, edits) if one.grave] == []


def test_a_third_of_the_mistakes_was_held_out():
    every = mistakes()
    assert len(every) == 60
    assert [one["held_out"] for one in every] == [i % 3 == 2 for i in range(60)]
