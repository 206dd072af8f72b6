"""``package://NAME/PATH`` in a scenario: a file of an installed package, or a plain refusal."""

import pytest

from quasistatic_ref import ScenarioError, load_scenario
from tests.cases import refusal
from tests.files.urdf.urdf_texts import link, robot
from tests.made import text_written


def arm_of(address):
    """The body of a scenario whose URDF has an address."""
    arm = {"urdf": address, "base": "floating"}
    return load_scenario({"h": 1, "steps": 1, "bodies": {"arm": arm}}).bodies["arm"]


@pytest.fixture
def share(tmp_path, monkeypatch):
    """A package `arms` with one file, and a file next to it, under a path of Python's."""
    folder = tmp_path / "site" / "cmeel.prefix" / "share"
    for file in ("arms/arm.urdf", "secret.urdf"):
        text_written(folder / file, robot(link("arm")))
    (folder / "arms" / "link.urdf").symlink_to(folder / "secret.urdf")
    monkeypatch.syspath_prepend(tmp_path / "site")
    return folder


def test_a_file_of_an_installed_package_is_taken_with_the_folder_of_all_packages(share):
    arm = arm_of("package://arms/arm.urdf")
    assert arm.urdf == share / "arms" / "arm.urdf"
    assert arm.package_dirs[1:] == (share,)


INSIDE = "must be a path inside the package"
PACKAGE = r"is not a file of an installed package; .* pip install 'quasistatic-ref\[robots\]'"
REFUSED = {
    "package://nowhere/arm.urdf": PACKAGE,
    "package://arms/leg.urdf": PACKAGE,
    "package://": PACKAGE,
    "package://arms": PACKAGE,
    "package://../share/secret.urdf": PACKAGE,
    "package://./secret.urdf": PACKAGE,
    "package://arms/../secret.urdf": INSIDE,
    "package://arms/link.urdf": INSIDE,
}


@pytest.mark.usefixtures("share")
@pytest.mark.parametrize("address", REFUSED)
def test_an_address_that_leads_nowhere_or_out_of_its_package_is_refused(address):
    with pytest.raises(ScenarioError, match=REFUSED[address]) as caught:
        arm_of(address)
    assert (caught.value.field, caught.value.value) == ("bodies.arm.urdf", address)


SCENE = """format = "quasistatic-ref/scenario"
version = 1
h = 0.1
steps = 1
[bodies.arm]
urdf = "arm.urdf"
base = "floating"
cloud = {}
"""
SLASH = "; write paths with / in place of backslashes"
WINDOWS = {
    r'"scans\\brick.csv"': "bodies.arm.cloud: names no file; a path begins at",
    r'"scans\brick.csv"': "bodies.arm.cloud: names no file; a path begins at",
    r"'scans\brick.csv'": "bodies.arm.cloud: names no file; a path begins at",
    r'"C:\temp\new.csv"': "bodies.arm.cloud: names no file; a path begins at",
    r'"scans\wall.csv"': "is not TOML: Unescaped ",
    r'"C:\Users\me\brick.csv"': "is not TOML: ",
    r'"scans\xyz\brick.csv"': "is not TOML: ",
}
"""Clouds of a scene as people on Windows write them, in strings with escapes and without."""


@pytest.mark.parametrize("cloud", WINDOWS)
def test_a_path_with_backslashes_is_told_to_have_slashes(tmp_path, cloud):
    text_written(tmp_path / "arm.urdf", robot(link("arm")))
    text_written(tmp_path / "scans" / "brick.csv", "0,0,0\n1,0,0\n")
    path = text_written(tmp_path / "scene.toml", SCENE.format(cloud))
    with refusal(ScenarioError, f"{path}: {WINDOWS[cloud]}", SLASH):
        load_scenario(path)
    text_written(path, SCENE.format('"scans/brick.csv"'))
    for setting in (r"bodies.arm.cloud=scans\brick.csv", r'bodies.arm.cloud="scans\brick.csv"'):
        with pytest.raises(ScenarioError, match=SLASH):
            load_scenario(path, [setting])


@pytest.mark.parametrize("path", [r"scenes\pinch", r"scenes\pinch.toml", "C:\temp\new.toml"])
def test_a_scene_with_backslashes_is_told_to_have_slashes(path):
    with pytest.raises(ScenarioError, match=SLASH):
        load_scenario(path)


def test_other_faults_of_toml_do_not_speak_of_paths(tmp_path):
    path = text_written(tmp_path / "scene.toml", "h = 0.1 0.2\n")
    with pytest.raises(ScenarioError) as refused:
        load_scenario(path)
    assert "backslash" not in str(refused.value)


def test_a_name_with_a_backslash_is_taken_where_there_is_such_a_file(tmp_path):
    text_written(tmp_path / "arm.urdf", robot(link("arm")))
    text_written(tmp_path / r"a\b.csv", "0,0,0\n1,0,0\n")
    path = text_written(tmp_path / "scene.toml", SCENE.format(r"'a\b.csv'"))
    assert load_scenario(path).bodies["arm"].urdf == tmp_path / "arm.urdf"
