"""Scenes of each finding are named with their cause; healthy ones have nothing grave."""

import re
from pathlib import Path

import pytest

from quasistatic_ref.optional.doctor.names import NAMES
from tests.meta.remedies import assert_alike, assert_among
from tests.optional.doctor.mistake_scenes import GRAVE, mistakes

FILES = [Path(__file__).with_name(f"{kind}_scenes.py") for kind in ("finding", "healthy")]
CELLS = "\n".join(file.read_text("utf-8") for file in FILES)
OF_DRAWN_SCENES = {"artifact", "corners", "equilibrium"}
WORDS, *SCENES = re.split(r"^# %% ", CELLS, flags=re.M)


@pytest.fixture(scope="module")
def words():
    """What the scenes are built with."""
    names = {}
    exec(WORDS, names)
    return names


@pytest.mark.parametrize("scene", SCENES, ids=[scene.splitlines()[0] for scene in SCENES])
def test_a_scene_is_named_with_its_cause(words, scene):
    title, _, code = scene.partition("\n")
    expected = title.partition(":")[0].split(", ")
    names = dict(words)
    exec(code, names)
    found = names["found"]
    if expected == ["nothing"] or title.startswith("no "):
        assert [str(one) for one in found if one.grave] == []
        assert {one.name for one in found}.isdisjoint(absent(title))
        return
    assert {*expected} <= {one.name for one in found}
    for one in found:
        assert one.sentence.startswith(one.cause)
        assert one.grave is GRAVE[one.name]
    for remedy, later in names.get("after", {}).items():
        mended = {one.name for one in found if one.remedy == remedy}
        assert mended, f"no finding has this remedy: {remedy}"
        assert mended.isdisjoint(one.name for one in later)


def absent(title):
    """The finding that a scene titled "no NAME: ..." only just lacks."""
    return re.findall(r"^no ([\w-]+):", title)


def test_each_finding_of_the_page_has_a_scene():
    of_cells = {name for scene in SCENES for name in scene.partition(":")[0].split(", ")}
    of_mistakes = {name for one in mistakes() for name in one["finding"]}
    assert_among(
        GRAVE,
        of_cells | OF_DRAWN_SCENES | of_mistakes,
        'No scene has the finding "{}": add a cell to tests/optional/doctor/finding_scenes.py',
    )
    assert_alike(
        GRAVE,
        NAMES,
        "{} is on docs/findings.md and not among NAMES: add it to optional/doctor/names.py",
        "{} is among NAMES of optional/doctor/names.py and not on docs/findings.md: add its row",
    )


def test_each_note_has_a_scene_that_only_just_lacks_it():
    """A healthy scene may have notes, so its title says which one it must not have."""
    assert_among(
        {name for name, grave in GRAVE.items() if not grave} - OF_DRAWN_SCENES,
        {name for scene in SCENES for name in absent(scene)},
        'No scene only just lacks "{}": add a cell "# %% no {}: ..." to '
        "tests/optional/doctor/healthy_scenes.py",
    )


@pytest.mark.parametrize(
    ("solve", "proof", "certify"), [(2.0, 7.9, "full"), (3.0, 9.0, "full"), (1.0, 11.0, "off")]
)
def test_a_shorter_run_or_one_with_less_proof_is_not_named(words, solve, proof, certify):
    """9.9 s are not long enough, 9 of 12 s are 75 %, and nothing is proved with off."""
    seconds = {"solve": solve, "proof": proof}
    tables = [("floor", "box", 0.5, 4)]
    assert words["findings"]([words["box"]()], tables, seconds=seconds, certify=certify) == ()
