"""Each finding of the page has a scene and an end, and each note one that only just lacks it."""

import numpy as np

import quasistatic_ref as qr
from quasistatic_ref.lab.bench.scenes import boxes
from quasistatic_ref.optional.doctor.texts import NAMES, NOTES
from tests.meta.remedies import assert_alike
from tests.optional.doctor.mistake_scenes import GRAVE, mistakes
from tests.optional.rows import CASES
from tests.wholes import wholes_formed


def test_each_finding_of_the_page_has_a_scene():
    of_rows = {name for case in CASES for name in case["hand"]}
    of_mistakes = {name for one in mistakes() for name in one["finding"]}
    assert_alike(
        GRAVE,
        of_rows | of_mistakes,
        'No scene has the finding "{}": add one to tests/optional/doctor/cases/findings.toml',
    )
    assert_alike(
        GRAVE,
        NAMES,
        "{} is on docs/findings.md and not among NAMES: add it to optional/doctor/texts.py",
        "{} is among NAMES of optional/doctor/texts.py and not on docs/findings.md: add its row",
    )


def test_each_note_has_a_scene_that_only_just_lacks_it():
    notes = {name for name, grave in GRAVE.items() if grave is False}
    assert notes == NOTES
    assert_alike(
        notes,
        {case.get("lacks") for case in CASES},
        'No scene only just lacks "{}": add one with lacks = "{}" to '
        "tests/optional/doctor/cases/findings.toml",
    )


def test_each_finding_ends_where_its_remedy_is_applied():
    """By `after` of a case, or by a mistake that is undone."""
    ended = {
        name
        for case in CASES
        for name, hand in case["hand"].items()
        if "after" in case and (len(case["hand"]) == 1 or hand.get("remedy") in case["after"])
    }
    undone = {one["finding"][0] for one in mistakes() if "remedy" in one}
    assert_alike(
        GRAVE,
        ended | undone,
        'No remedy of "{}" is applied: write after."REMEDY" = { ... } into one of its cases in '
        "tests/optional/doctor/cases",
    )


def test_findings_of_many_bodies_form_no_whole_arrays(monkeypatch):
    """Of 1000 boxes J has 0.8 GB. What 500 N push off leaves its place by leaps."""
    scene = boxes(50)
    n_v = len(scene.force)
    simulator = scene.simulator("off", True)
    wholes = wholes_formed(n_v, monkeypatch)
    options = {"force": 500 * scene.force, "record": "light", "progress": False}
    run = qr.rollout(simulator, scene.q, np.zeros(0), 6, **options)
    assert len(run.findings) > 0
    assert not wholes
