"""The first finding names the mistake of each scene that has one; scenes without one have none."""

import pytest

from tests.optional.doctor.mistake_scenes import (
    BEFORE,
    GRAVE,
    SCENES,
    findings_after,
    healthy_scenes,
    mistakes,
)

WEAK_GRIP = next(one for one in mistakes() if one["what"] == "no friction in the grip")


def one_for_each_finding():
    """All mistakes; those that are not the first of their findings are long."""
    seen = set()
    for mistake in mistakes():
        findings = frozenset(mistake["finding"])
        marks = pytest.mark.long if findings in seen else ()
        yield pytest.param(mistake, id=mistake["what"], marks=marks)
        seen.add(findings)


@pytest.mark.shared
@pytest.mark.parametrize("mistake", list(one_for_each_finding()))
def test_a_mistake_is_named_in_the_first_finding(mistake, tmp_path):
    short = ["steps=10"] if BEFORE.issuperset(mistake["finding"]) else []
    findings = findings_after(tmp_path, mistake["scene"], mistake["edits"], short)
    assert findings[0].name in mistake["finding"]
    assert GRAVE[findings[0].name] in (None, findings[0].grave)
    assert all(word in findings[0].sentence for word in mistake["words"]), findings[0].sentence
    assert findings[0].remedy == mistake.get("remedy", findings[0].remedy)


def test_the_remedy_of_each_finding_of_a_mistake_is_read():
    """Each undoes its mistake, and the scene without it has no finding."""
    named = {name for one in mistakes() for name in one["finding"][:1]}
    assert {one["finding"][0] for one in mistakes() if "remedy" in one} == named


@pytest.mark.parametrize("scene", SCENES)
def test_a_scene_without_a_mistake_has_no_finding(scene, tmp_path):
    assert findings_after(tmp_path, scene) == ()


def test_a_box_that_comes_down_from_its_layer_once_its_pusher_stops_has_settled(tmp_path):
    """The layer 0.4 h v = 0.3 mm under the box is lost, and its pusher's spring goes on by 0.2."""
    assert findings_after(tmp_path, "push", fast=False) == ()


WITHOUT_MISTAKE = [*healthy_scenes("healthy")[1::4], *healthy_scenes("near_miss")]


@pytest.mark.shared
@pytest.mark.parametrize("one", WITHOUT_MISTAKE, ids=lambda one: one["what"])
def test_a_scene_without_a_mistake_has_no_grave_finding_however_it_is_made(one, tmp_path):
    findings = findings_after(tmp_path, one["scene"], one["edits"])
    assert [str(x) for x in findings if x.grave] == []


@pytest.mark.parametrize(
    "record", ["full", "light", pytest.param("forces", marks=pytest.mark.long)]
)
def test_findings_do_not_depend_on_the_record(record, tmp_path):
    settings = [f"record={record}"]
    findings = findings_after(tmp_path, "grasp", WEAK_GRIP["edits"], settings)
    assert [one.name for one in findings] == ["lost-grip"]
