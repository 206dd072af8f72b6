"""Files that are not what their readers expect, down to the bytes: TOML, JSON, XML, ZIP alike."""

import os

import pytest

from quasistatic_ref.model.urdf.urdf_xml import DEEPEST
from tests.errors.scene import scene_written

READERS = ("scene.toml", "step.json", "ball.urdf", "run.npz", "cloud.xyz")
DEEP = 100_000

NO_TRAJECTORY = "is not a trajectory written by this program"
NOT_UTF8 = "line 1: is not UTF-8 text"
CAUSES = {
    # name: file, content, words of the sentence
    "empty TOML": ("scene.toml", b"", "format: is missing"),
    "empty JSON": ("step.json", b"", "is not JSON: Expecting value: line 1"),
    "empty trajectory": ("run.npz", b"", NO_TRAJECTORY),
    "binary trajectory": ("run.npz", bytes(range(128, 256)), NO_TRAJECTORY),
    "Latin-1 XML": ("ball.urdf", '<robot name="Jürgen"/>'.encode("latin-1"), NOT_UTF8),
    "NUL in JSON": ("step.json", b'{"h": 1\x00}', "is not JSON: "),
    "TOML without end": ("scene.toml", b"a = " + b"[" * DEEP, "is nested too deeply"),
    "a word without end": ("scene.toml", b"a" * 2**20, "is not TOML: "),
    "very many keys": (
        "scene.toml", b"".join(b"a%d=1\n" % i for i in range(90_000)),
        "a0: is unknown; known: bodies, cone",
    ),
    "JSON without end": ("step.json", b"[" * DEEP + b"]" * DEEP, "is not usable JSON: too deep"),
    "XML without end": ("ball.urdf", b"<a>" * (DEEPEST + 1) + b"</a>" * (DEEPEST + 1),
        "line 1: is nested deeper"),
    "a number of many digits in TOML": ("scene.toml", b"h = " + b"1" * 5000, "an unusable number"),
    "a number of many digits in JSON": ("step.json", b'{"h": ' + b"1" * 5000 + b"}", "too long"),
    "an entity": (
        "ball.urdf", b'<!DOCTYPE r [<!ENTITY x "ball">]><robot name="&x;"/>',
        "line 1: a DOCTYPE is not allowed",
    ),
    "a file as an entity": (
        "ball.urdf", b'<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot name="&x;"/>',
        "a DOCTYPE is not allowed",
    ),
    "a field twice in TOML": ("scene.toml", b"h = 1\nh = 2\n", "is not TOML: Cannot overwrite"),
    "a field twice in JSON": ("step.json", b'{"h": 1, "h": 2}', "h: is given twice (got 2)"),
    "an attribute twice in XML": ("ball.urdf", b'<robot name="a" name="b"/>', "duplicate attr"),
    "half a character": ("step.json", b'{"format": "\\ud800"}', "holds half of a character"),
    "a point out of this world": ("cloud.xyz", b"1 2 3\n0 0 1e154\n", "point 1: its coordinates"),
}  # fmt: skip


def command(folder, file):
    """The command that reads the file of that name."""
    path = folder / file
    if file == "step.json":
        return ["solve", path, "-o", folder / "solution.json"]
    if file == "run.npz":
        return ["extract", path, "--step", 0, "-o", folder / "out.json"]
    if file in ("ball.urdf", "cloud.xyz"):
        options = ["--set", "bodies.ball.cloud=cloud.xyz"] if file == "cloud.xyz" else []
        return ["run", folder / "scene.toml", *options, "--out", folder / "out"]
    return ["run", path, "--out", folder / "out"]


@pytest.mark.parametrize("cause", CAUSES)
def test_a_file_that_is_something_else_is_refused(tmp_path, refused, cause):
    file, content, words = CAUSES[cause]
    scene_written(tmp_path)
    (tmp_path / file).write_bytes(content)
    sentence = refused(*command(tmp_path, file))
    assert sentence.startswith(f"{tmp_path / file}: ")
    assert words in sentence
    assert len(sentence) < 400 + len(str(tmp_path))


SPOILERS = {
    "missing": (lambda path: None, "no such file"),
    "a folder": (lambda path: path.mkdir(), "cannot be read: Is a directory"),
    "a pipe": (os.mkfifo, "cannot be read: it is a device or a pipe, not a file"),
    "a device without end": (lambda path: path.symlink_to("/dev/zero"), "it is a device or a pipe"),
    "too large": (
        lambda path: (path.touch(), os.truncate(path, 2**30)),
        ("is larger than ", " MiB"),
    ),
}


@pytest.mark.parametrize("file", READERS)
@pytest.mark.parametrize("kind", SPOILERS)
def test_what_is_no_file_is_refused(tmp_path, refused, file, kind):
    spoil, words = SPOILERS[kind]
    scene_written(tmp_path)
    (tmp_path / file).unlink(missing_ok=True)
    spoil(tmp_path / file)
    arguments = command(tmp_path, file)
    if file == "ball.urdf":  # by --set, since the link leaves the folder
        arguments += ["--set", "bodies.ball.urdf=ball.urdf"]
    sentence = refused(*arguments)
    assert sentence.startswith(f"{tmp_path / file}: ")
    assert all(word in sentence for word in ([words] if isinstance(words, str) else words))
