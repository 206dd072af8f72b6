"""Scenes of each finding are named with their cause; healthy ones have nothing grave."""

import re
from pathlib import Path

import pytest

from quasistatic_ref.optional.doctor.names import NAMES
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
    if expected == ["nothing"]:
        assert [str(one) for one in found if one.grave] == []
        return
    assert {*expected} <= {one.name for one in found}
    for one in found:
        assert one.sentence.startswith(one.cause)
        assert one.grave is GRAVE[one.name]


def test_each_finding_of_the_page_has_a_scene():
    of_cells = {name for scene in SCENES for name in scene.partition(":")[0].split(", ")}
    of_mistakes = {name for one in mistakes() for name in one["finding"]}
    assert of_cells | {"nothing"} | OF_DRAWN_SCENES | of_mistakes >= set(GRAVE)
    assert set(GRAVE) == NAMES


@pytest.mark.parametrize(
    ("solve", "proof", "certify"), [(2.0, 7.9, "full"), (3.0, 9.0, "full"), (1.0, 11.0, "off")]
)
def test_a_shorter_run_or_one_with_less_proof_is_not_named(words, solve, proof, certify):
    """9.9 s are not long enough, 9 of 12 s are 75 %, and nothing is proved with off."""
    seconds = {"solve": solve, "proof": proof}
    tables = [("floor", "box", 0.5, 4)]
    assert words["findings"]([words["box"]()], tables, seconds=seconds, certify=certify) == ()
