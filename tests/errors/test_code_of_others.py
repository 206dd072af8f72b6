"""Files of others name no code and no path outside: no field of a scenario does."""

import sys

import pytest

from quasistatic_ref import InputError, load_scenario
from tests.errors.scene import SCENE, changed, scene_written

HELPER = """
import pathlib
pathlib.Path(__file__).with_name("it_ran").touch()
def solve(P, q, G, h):
    return None, None, "no"
"""
CODE = ("helper.py:solve", "helper:solve", "./helper.py:solve", "os:system")
WORDS = (
    "format", "cone", "law", "record", "solver/backend", "solver/certify", "bodies/rail/urdf",
     "bodies/rail/base", "bodies/rail/actuated", "bodies/rail/joint_limits",
     "bodies/rail/joint_friction", "bodies/ball/cloud", "shapes/scan/mesh/file",
     "contacts/push/alpha", "contacts/push/beta", "contacts/push/k/within",
)  # fmt: skip
"""Every field of a scenario that is a word."""
LISTS = ("roots", "bodies/rail/package_dirs", "bodies/rail/actuated")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A working folder with a good scene, and a module that says whether it was imported."""
    monkeypatch.setattr(sys, "path", [*sys.path])
    place = tmp_path / "scene"
    place.mkdir()
    monkeypatch.chdir(place)
    scene_written(place)
    (place / "helper.py").write_text(HELPER)
    yield place
    assert not (place / "it_ran").exists()
    sys.modules.pop("helper", None)


def spoilt(field, word):
    """The scene with a word in a field, and in a list where the field is one."""
    scene = SCENE
    if field.startswith("shapes/scan"):
        scene = changed(scene, ("shapes/scan", {"mesh": {}}))
    if field == "contacts/push/k/within":
        scene = changed(scene, ("contacts/push/k", {}))
    if field in LISTS:
        word = [word]
    return changed(scene, (field, word))


@pytest.mark.parametrize("field", [*WORDS, *LISTS])
def test_no_field_of_a_scenario_runs_code(folder, field):
    for word in CODE:
        scene = spoilt(field, word)
        with pytest.raises(InputError):
            load_scenario(scene_written(folder, scene))
        with pytest.raises(InputError):
            load_scenario(scene, of_others=True)


def test_code_is_named_by_the_user_alone(folder, refused, cli):
    path = scene_written(folder, changed(SCENE, ("solver/backend", "helper.py:solve")))
    sentence = refused("run", path)
    words = "would run code, which no file may; give it as --backend FILE.py:NAME"
    assert sentence == f"{path}: solver.backend: {words} (got 'helper.py:solve')"
    path = scene_written(folder)
    for option in (["--backend", "helper.py:solve"], ["--set", "solver.backend=helper.py:solve"]):
        cli("run", path, *option, "--quiet", "--out", folder / "out")
        (folder / "it_ran").unlink()
        sys.modules.pop("helper", None)
    load_scenario(path, {"solver.backend": "helper.py:solve"}, steps=1).run()
    load_scenario(changed(SCENE, ("solver/backend", "helper:solve"))).run()
    (folder / "it_ran").unlink()


def test_a_module_beside_a_function_takes_no_installed_ones_place(folder):
    (folder / "fractions.py").write_text("raise SystemExit")
    (folder / "helper.py").write_text("import scipy.optimize, colorsys\n" + HELPER)
    (folder / "colorsys.py").write_text("raise SystemExit('taken')")
    scene = changed(SCENE, ("solver/backend", "helper.py:solve"))
    load_scenario(scene, steps=1).run()
    (folder / "it_ran").unlink()


def test_a_name_that_holds_a_dot_is_not_where_the_user_s_change_leads(folder):
    (folder.parent / "out.xyz").touch()
    ball = SCENE["bodies"]["ball"]
    scene = changed(SCENE, ("bodies/ball.cloud", {**ball, "cloud": "../out.xyz"}))
    with pytest.raises(InputError, match=r"bodies\.ball\.cloud\.cloud: is outside the scenario"):
        load_scenario(scene, {"bodies.ball.cloud": "cloud.xyz"}, of_others=True)
