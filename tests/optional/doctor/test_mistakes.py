"""The first finding names the mistake of each scene that has one; scenes without one have none."""

import pytest

from tests.optional.doctor.mistake_scenes import (
    GRAVE,
    SCENES,
    findings_after,
    healthy_scenes,
    mistakes,
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
WEAK_GRIP = next(one for one in mistakes() if one["what"] == "no friction in the grip")


def one_for_each_finding():
    """All mistakes; those that are not the first of their findings are long."""
    seen = set()
    for mistake in mistakes():
        findings = frozenset(mistake["finding"])
        marks = pytest.mark.long if findings in seen else ()
        yield pytest.param(mistake, id=mistake["what"], marks=marks)
        seen.add(findings)


@pytest.mark.parametrize("mistake", list(one_for_each_finding()))
def test_a_mistake_is_named_in_the_first_finding(mistake, tmp_path):
    findings = findings_after(tmp_path, mistake["scene"], mistake["edits"])
    assert findings[0].name in mistake["finding"]
    assert findings[0].grave >= GRAVE[findings[0].name]
    assert all(word in findings[0].sentence for word in mistake["words"]), findings[0].sentence


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_without_a_mistake_has_no_finding(scene, tmp_path):
    assert findings_after(tmp_path, scene) == ()


def test_what_comes_down_from_its_layer_once_its_pusher_stops_has_settled(tmp_path):
    """The layer 0.4 h v = 0.3 mm under the box is lost, and its pusher's spring goes on by 0.2."""
    assert findings_after(tmp_path, "push", fast=False) == ()


@pytest.mark.parametrize("one", healthy_scenes()[1::4], ids=lambda one: one["what"])
def test_a_scene_without_a_mistake_has_no_grave_finding_however_it_is_made(one, tmp_path):
    findings = findings_after(tmp_path, one["scene"], one["edits"])
    assert [str(x) for x in findings if x.grave] == []


@pytest.mark.parametrize("what", NEAR_MISSES)
def test_a_near_miss_has_no_finding_that_is_grave(what, tmp_path):
    scene, edits = NEAR_MISSES[what]
    assert [str(one) for one in findings_after(tmp_path, scene, edits) if one.grave] == []


@pytest.mark.parametrize("record", ["full", "light", "forces"])
def test_findings_do_not_depend_on_the_record(record, tmp_path):
    settings = [f"record={record}"]
    findings = findings_after(tmp_path, "grasp", WEAK_GRIP["edits"], settings)
    assert [one.name for one in findings] == ["lost grip"]
