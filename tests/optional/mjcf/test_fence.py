"""What an MJCF file may read, and how much it may ask for."""

import os

import pytest

from quasistatic_ref import ModelError, ScenarioError, load_scenario
from quasistatic_ref.optional.mjcf import compiler
from quasistatic_ref.optional.mjcf.mjcf import mjcf_urdf
from tests.model.urdf.urdf_texts import urdf_of_text

BODY = '<mujoco><worldbody><body name="b"><joint/><geom size="0.1"/></body></worldbody></mujoco>'


SCENE = """format = "quasistatic-ref/scenario"
version = 1
h = 0.01
steps = 1
[bodies.b]
mjcf = "m.xml"
"""


def model(inside):
    return f'<mujoco>{inside}<worldbody><body><geom size="0.1"/></body></worldbody></mujoco>'


@pytest.fixture
def home(tmp_path):
    """A folder with a file outside of it, and a pipe inside."""
    urdf_of_text(tmp_path, BODY, "outside.xml")
    home = tmp_path / "home"
    home.mkdir()
    os.mkfifo(home / "pipe.xml")
    (home / "link.xml").symlink_to(tmp_path / "outside.xml")
    return home


MESH = '<asset><mesh name="m" file="outside.xml"/></asset>'
REFUSED = {
    # name: (the model, words of the sentence)
    "an include": ('<include file="../outside.xml"/>', "include.file: leads to "),
    "an absolute include": ('<include file="{home}/../outside.xml"/>', "folder: --root FOLDER"),
    "a link": ('<include file="link.xml"/>', "include.file: leads to "),
    "an attached model": (
        '<asset><model name="m" file="../outside.xml"/></asset>', "model[m].file: leads to "
    ),
    "a mesh's folder": (f'<compiler meshdir=".."/>{MESH}', "mesh[m].file: leads to "),
    "a pipe": ('<include file="pipe.xml"/>', "include.file: is a folder, a device or a pipe"),
    "replicas": (
        '<worldbody><replicate count="200"><replicate count="200"><geom size="1"/></replicate>'
        "</replicate></worldbody>", "replicate.count: makes more than 1000 copies",
    ),
    "a height field": (
        '<asset><hfield name="f" nrow="20000" ncol="20000" size="1 1 1 1"/></asset>',
        "hfield[f].ncol: makes more than 4000000 parts or numbers (got '20000')",
    ),
    "elements in elements": (
        "<worldbody>" + "<body>" * 400 + "</body>" * 400 + "</worldbody>",
        "body: is nested deeper than 300 elements",
    ),
    "many bodies": (
        "<worldbody>" + '<body name="c"/>' * 1001 + "</worldbody>",
        "body[c]: is one of more than 1000 bodies",
    ),
    "memory": (
        '<size memory="10T"/>', "size.memory: MuJoCo refuses it: Error: engine error: Could not"
    ),
    "an unknown attribute": ('<option foo="1"/>', "option.foo: MuJoCo refuses it: XML Error: "),
    "a size": (
        '<worldbody><body name="c"><geom name="g" type="box" size="1"/></body></worldbody>',
        "geom[g].size: MuJoCo refuses it: Error: size 1 must be positive in geom",
    ),
    "an unknown mesh": (
        '<worldbody><body name="c"><geom type="mesh" mesh="none"/></body></worldbody>',
        "geom.mesh: MuJoCo refuses it: Error: mesh 'none' not found",
    ),
    "user data": ('<size nuserdata="400000000"/>', "size.nuserdata: must be at most 4000000"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
def test_a_model_that_reads_elsewhere_or_asks_for_too_much_is_refused(home, case):
    inside, says = REFUSED[case]
    path = urdf_of_text(home, model(inside.replace("{home}", str(home))), "m.xml")
    with pytest.raises(ModelError) as caught:
        mjcf_urdf(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert says in str(caught.value)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"<!DOCTYPE mujoco [<!ENTITY a 'b'>]>" + BODY.encode(), "declares a DOCTYPE"),
        (BODY.encode().replace(b'"b"', b'"\xff"'), "line 1: is not UTF-8 text"),
        (b"<mujoco>", "is not XML: "),
    ],
)
def test_what_is_no_plain_xml_is_refused(tmp_path, content, says):
    path = tmp_path / "m.xml"
    path.write_bytes(content)
    with pytest.raises(ModelError) as caught:
        mjcf_urdf(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert says in str(caught.value)


def test_a_folder_that_is_named_may_be_read(home, tmp_path, cli):
    text = '<mujoco><include file="../outside.xml"/></mujoco>'
    path = urdf_of_text(home, text, "m.xml")
    with pytest.raises(ModelError, match="outside the folder of the model"):
        mjcf_urdf(path)
    assert '<link name="b">' in mjcf_urdf(path, roots=[tmp_path])
    scene = urdf_of_text(home, SCENE, "scene.toml")
    assert "m.xml: include.file: leads to " in cli("inspect", scene, status=2).err
    cli("inspect", scene, "--root", tmp_path)
    assert load_scenario(scene, roots=[tmp_path]).system.links == ("world", "b/worldbody", "b/b")


@pytest.mark.parametrize("field", ["roots", "bodies.b.package_dirs"])
def test_a_scenario_cannot_name_folders_outside_of_its_own(home, tmp_path, field):
    line = f'{field.rpartition(".")[2]} = [".."]'
    text = SCENE + line if "." in field else f"{line}\n{SCENE}"
    with pytest.raises(ScenarioError, match=r"is outside the scenario's folder; .* --root FOLDER"):
        load_scenario(urdf_of_text(home, text, "scene.toml"))
    with pytest.raises(ScenarioError, match=rf"{field}: is no folder"):
        load_scenario(urdf_of_text(home, text.replace("..", "m.xml"), "scene.toml"))


def test_a_compilation_that_takes_too_long_is_ended(tmp_path, monkeypatch):
    monkeypatch.setattr(compiler, "SECONDS", 1)
    monkeypatch.setattr(compiler, "PATIENCE", None)  # by the clock
    keys = BODY.replace("<worldbody>", '<size nkey="3000000"/><worldbody>')
    with pytest.raises(ModelError, match=r"size\.nkey: takes MuJoCo longer than 1 s"):
        mjcf_urdf(urdf_of_text(tmp_path, keys, "m.xml"))


def test_time_in_which_others_use_the_processor_does_not_count(tmp_path, monkeypatch):
    """The process waits for longer than the time of the processor that it is given."""
    monkeypatch.setattr(compiler, "SECONDS", 1)
    waits = "import os, time\ntime.sleep(1.1)\nos.write(1, b'done')\nos._exit(0)\n"
    urdf_of_text(tmp_path, waits, "sitecustomize.py")
    monkeypatch.syspath_prepend(tmp_path)
    assert compiler.printed(tmp_path / "m.xml") == b"done"


def test_a_warning_of_mujocos_is_not_printed_or_written(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    nan = BODY.replace('size="0.1"', 'size="0.1" pos="NaN 0 0"')
    with pytest.raises(ModelError):
        mjcf_urdf(urdf_of_text(tmp_path, nan, "m.xml"))
    assert [file.name for file in tmp_path.iterdir()] == ["m.xml"]
    assert capfd.readouterr().err == ""
