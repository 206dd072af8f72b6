"""Files of others name no code and no path outside: no field of a scenario does."""

import io
import json
import sys

import pytest

from quasistatic_ref import InputError, load_scenario
from quasistatic_ref.lab.oracle.pipes import lines_served
from quasistatic_ref.lab.oracle.served import Scenes
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
    (tmp_path / "rail.urdf").write_text((place / "rail.urdf").read_text())
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


def served(tables):
    """What a server answers to a client that sends a scene."""
    out = io.StringIO()
    request = json.dumps({"scene": "sent", "tables": tables})
    lines_served(Scenes([], ()), io.BytesIO(request.encode()), out)
    return json.loads(out.getvalue().splitlines()[-1])


@pytest.mark.parametrize("field", [*WORDS, *LISTS])
def test_no_field_of_a_scenario_runs_code(folder, field):
    for word in CODE:
        scene = spoilt(field, word)
        with pytest.raises(InputError):
            load_scenario(scene_written(folder, scene))
        with pytest.raises(InputError):
            load_scenario(scene, of_others=True)
        assert served(scene)["status"] == 2


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


@pytest.mark.parametrize(
    "field", ["bodies/rail/urdf", "bodies/ball/cloud", "shapes/scan/mesh/file"]
)
@pytest.mark.parametrize("way", ["relative", "absolute"])
def test_a_client_reads_nothing_outside_of_the_folder_that_is_served(folder, field, way):
    outside = "../rail.urdf" if way == "relative" else str(folder.parent / "rail.urdf")
    if "mesh" in field:
        outside = outside.replace("urdf", "obj")
        (folder.parent / "rail.obj").touch()
    answer = served(spoilt(field, outside))
    assert answer["status"] == 2
    assert field.split("/")[-1] in answer["error"]


def test_a_client_reads_from_folders_that_the_user_names(folder, tmp_path):
    assert served(SCENE)["scene"] == "sent"
    scene = changed(SCENE, ("bodies/rail/urdf", str(tmp_path / "rail.urdf")))
    assert "is outside the scenario's folder" in served(scene)["error"]
    out = io.StringIO()
    scenes = Scenes([f'roots=["{tmp_path}"]'], [tmp_path])
    requests = [{"scene": "sent", "tables": scene}, {"file": str(tmp_path / "other.toml")},
                {"file": "/etc/hostname"}]  # fmt: skip
    (tmp_path / "other.toml").write_text("")
    lines_served(scenes, io.BytesIO("\n".join(map(json.dumps, requests)).encode()), out)
    _, sent, known, unknown = map(json.loads, out.getvalue().splitlines())
    assert sent["scene"] == "sent"
    assert "format: is missing" in known["error"]
    assert "is outside of the folder that is served; serve with --root FOLDER" in unknown["error"]
