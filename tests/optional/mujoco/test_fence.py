"""What an MJCF file may read, and how much it may ask for."""

import os
import shlex
import sys

import mujoco
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.optional.mujoco import compiler
from tests.cases import cases
from tests.files.urdf.urdf_texts import urdf_of_text
from tests.helpers import one_sentence
from tests.made import text_written
from tests.oracles.shape_files import TETRAHEDRON

BODY = '<mujoco><worldbody><body name="b"><joint/><geom size="0.1"/></body></worldbody></mujoco>'


def model(inside):
    return f'<mujoco>{inside}<worldbody><body><geom size="0.1"/></body></worldbody></mujoco>'


@pytest.fixture
def refusal(cli):
    """Why the model of a file is refused, which the sentence names first."""

    def said(path):
        sentence = one_sentence(cli("opinion", path, status=2).err)
        assert sentence.startswith(f"{path}: ")
        return sentence

    return said


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
    "an absolute include": ('<include file="{home}/../outside.xml"/>', "folder: --root "),
    "a link": ('<include file="link.xml"/>', "include.file: leads to "),
    "an attached model": (
        '<asset><model name="m" file="../outside.xml"/></asset>', "model[m].file: leads to "
    ),
    "a mesh's folder": (f'<compiler meshdir=".."/>{MESH}', "mesh[m].file: leads to "),
    "a pipe": ('<include file="pipe.xml"/>', "include.file: is a folder, a device or a pipe"),
    "many bodies": (
        '<worldbody><replicate count="1001"><body/></replicate></worldbody>',
        "replicate.count: makes 1003 bodies, more than 1000",
    ),
    "a height field": (
        '<asset><hfield name="f" nrow="40000" ncol="40000" size="1 1 1 1"/></asset>',
        "hfield[f].ncol: needs more than ",
    ),
    "a mesh": (
        '<asset><mesh name="m" builtin="plate" params="2000 3000"/></asset>',
        "mesh[m].params: takes MuJoCo longer than 1 s",
    ),
    "memory": (
        '<size memory="10T"/>', "size.memory: needs more than the 2 GiB that this package lets"
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
    "user data": (
        '<size nuserdata="400000000"/>', "size.nuserdata: needs more than the 2 GiB that this"
    ),
}  # fmt: skip


LIKE_OTHERS = "a height field", "a size", "an unknown mesh", "user data"
"""Cases that take a process of their own, as others do that ask for the same."""
EACH = [pytest.param(c, marks=pytest.mark.long if c in LIKE_OTHERS else ()) for c in REFUSED]


@pytest.mark.parametrize("case", EACH)
def test_a_model_that_reads_elsewhere_or_asks_for_too_much_is_refused(
    home, case, monkeypatch, refusal
):
    if case == "a mesh":
        monkeypatch.setattr(compiler, "SECONDS", 1)
    inside, says = REFUSED[case]
    text = model(inside.replace("{home}", str(home)))
    assert says in refusal(urdf_of_text(home, text, "m.xml"))


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"<!DOCTYPE mujoco [<!ENTITY a 'b'>]>" + BODY.encode(), "declares a DOCTYPE"),
        (BODY.encode().replace(b'"b"', b'"\xff"'), "line 1: is not UTF-8 text"),
        (b"<mujoco>", "is not XML: "),
    ],
)
def test_xml_that_is_not_plain_is_refused(tmp_path, content, says, refusal):
    path = tmp_path / "m.xml"
    path.write_bytes(content)
    assert says in refusal(path)


def test_a_folder_that_is_named_may_be_read(home, tmp_path, cli, refusal):
    text = '<mujoco><include file="../outside.xml"/></mujoco>'
    path = urdf_of_text(home, text, "m.xml")
    sentence = refusal(path)
    assert "m.xml: include.file: leads to " in sentence
    assert "outside the folder of the model" in sentence
    assert compiler.compiled_model(path, [tmp_path]).body(1).name == "b"
    cli("opinion", path, "--settle 0 --root", tmp_path)


TETRAHEDRA = '<asset><mesh name="m" file="{}"/></asset>'
BESIDE = {
    # name: (the model, where the mesh is, what else is there, the folder to name or None)
    "a mesh's folder beside": ('<compiler meshdir="../meshes"/>', "m.obj", "meshes/m.obj", None),
    "an asset's": ('<compiler assetdir="../assets"/>', "a/m.obj", "assets/a/m.obj", None),
    "a path": ("", "../meshes/m.obj", "meshes/m.obj", None),
    "the folder above": ('<compiler meshdir=".."/>', "m.obj", "m.obj", "."),
    "a folder above that": ('<compiler meshdir="../../up"/>', "m.obj", "../up/m.obj", "../up"),
    "in a repository": ('<compiler meshdir="../.."/>', "m.obj", "../m.obj", ".git"),
    "a link beside": ('<compiler meshdir="../link"/>', "m.obj", "far/off/m.obj", "far/off"),
}


@cases("inside, file, place, named", BESIDE)
def test_a_model_reads_where_a_urdf_reads(tmp_path, inside, file, place, named, refusal):
    """Where it does not, the sentence prints the option that suffices."""
    home = tmp_path / "top" / "robot" / "xml"
    home.mkdir(parents=True)
    text_written(home.parent / place, TETRAHEDRON)
    (home.parent / "link").symlink_to(home.parent / "far" / "off")
    if named == ".git":
        (tmp_path / "top" / ".git").mkdir()
    path = urdf_of_text(home, model(inside + TETRAHEDRA.format(file)), "m.xml")
    if named in (None, ".git"):
        assert compiler.compiled_model(path).nmesh == 1
        return
    root = (home.parent / named).resolve()
    sentence = refusal(path) + " "
    assert f"mesh[m].file: leads to {root / 'm.obj'}, outside the folder" in sentence
    assert f"name its folder: --root {shlex.quote(str(root))} " in sentence
    assert compiler.compiled_model(path, [root]).nmesh == 1


def test_a_model_has_the_numbers_that_mujoco_compiles(tmp_path):
    path = urdf_of_text(tmp_path, BODY, "m.xml")
    known = mujoco.MjModel.from_xml_path(str(path))
    model = compiler.compiled_model(path)
    for name in ("body_mass", "body_inertia", "geom_size", "jnt_axis", "qpos0"):
        assert getattr(model, name).tobytes() == getattr(known, name).tobytes()
    assert model.narena == known.narena


def test_without_mujoco_one_sentence_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(InputError, match=r"needs mujoco: pip install 'quasistatic-ref\[engines\]'"):
        compiler.compiled_model(urdf_of_text(tmp_path, BODY, "m.xml"))


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
    compiler.compiled_model(urdf_of_text(tmp_path, nan, "m.xml"))
    assert [file.name for file in tmp_path.iterdir()] == ["m.xml"]
    assert capfd.readouterr().err == ""
