"""Files are written whole or not at all, read with plain errors, and hold honest numbers."""

import math
import os
import stat
import subprocess
import sys
import tempfile

import numpy as np
import pytest

from quasistatic_ref import InputError, load_trajectory
from quasistatic_ref.text.content import json_read, text_of, text_written, toml_read, written_whole
from quasistatic_ref.text.json_text import json_text
from tests.cases import cases, refusal
from tests.files.urdf.urdf_texts import loaded_urdf


def test_a_text_is_written_in_utf_8_and_folders_are_made(tmp_path):
    path = tmp_path / "a" / "b" / "t.txt"
    assert text_written(path, "μ_ω\n") == path
    assert path.read_bytes() == "μ_ω\n".encode()


def test_a_file_is_replaced_whole(tmp_path):
    path = tmp_path / "t.txt"
    text_written(path, "a long text, of which nothing is left")
    text_written(path, "short")
    assert path.read_text() == "short"
    assert os.listdir(tmp_path) == ["t.txt"]


def test_a_file_has_the_permissions_of_any_other(tmp_path):
    ordinary = tmp_path / "ordinary"
    ordinary.touch()
    written = text_written(tmp_path / "t.txt", "")
    assert stat.S_IMODE(written.stat().st_mode) == stat.S_IMODE(ordinary.stat().st_mode)


FULL = OSError(28, "No space left on device")


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (RuntimeError("the writer failed"), "failed"),
        (KeyboardInterrupt(), None),
        (FULL, "cannot be written: No space left on device; choose another"),
    ],
)
def test_a_writer_that_fails_leaves_the_old_file_and_nothing_else(tmp_path, error, says):
    def write(file):
        file.write(b"half of it")
        raise error

    old = text_written(tmp_path / "t.txt", "old")
    for path in (old, tmp_path / "t.bin"):
        with pytest.raises(InputError if error is FULL else type(error), match=says):
            written_whole(path, write)
    assert old.read_text() == "old"
    assert os.listdir(tmp_path) == ["t.txt"]


def test_the_half_written_file_of_a_killed_process_is_removed(tmp_path):
    """By another process, and not what a third one is writing."""
    program = (
        "import sys; from quasistatic_ref.text.content import *; written_whole(sys.argv[1], {})"
    )
    waits = "lambda file: (print(1, flush=True), input())"
    writers = [
        subprocess.Popen([sys.executable, "-c", program.format(waits), tmp_path / name],
                         stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        for name in ("a", "b")
    ]  # fmt: skip
    for writer in writers:
        assert writer.stdout.readline()
    writers[0].kill()
    writers[0].communicate()
    assert len(list(tmp_path.glob(".*.partial"))) == 2
    done = [sys.executable, "-c", program.format("lambda file: file.write(b'c')"), tmp_path / "c"]
    subprocess.run(done, check=True)
    (left,) = tmp_path.glob(".*.partial")
    assert left.name.startswith(".b.")
    writers[1].communicate(b"\n")
    assert sorted(os.listdir(tmp_path)) == ["b", "c"]


def test_a_file_that_another_process_sweeps_as_it_is_made_is_made_once_more(tmp_path, monkeypatch):
    made = []

    def swept_at_first(*arguments):
        made.append(mkstemp(*arguments))
        if len(made) == 1:
            os.unlink(made[0][1])
        return made[-1]

    mkstemp = tempfile.mkstemp
    monkeypatch.setattr(tempfile, "mkstemp", swept_at_first)
    assert text_written(tmp_path / "t.txt", "text").read_text() == "text"
    assert len(made) == 2
    assert os.listdir(tmp_path) == ["t.txt"]


def test_a_pipe_and_a_fifo_are_written_into(tmp_path):
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    reader = os.open(fifo, os.O_RDONLY | os.O_NONBLOCK)
    one, other = os.pipe()
    for name, end in ((fifo, reader), (f"/dev/fd/{other}", one)):
        text_written(name, "text")
        assert os.read(end, 100) == b"text"
    assert stat.S_ISFIFO(fifo.stat().st_mode)
    for descriptor in (reader, one, other):
        os.close(descriptor)


@pytest.mark.parametrize("error", [RuntimeError, FULL])
def test_a_writer_that_fails_sends_nothing_down_a_pipe(error):
    def write(file):
        file.write(b"half of it")
        raise error

    one, other = os.pipe()
    with pytest.raises((RuntimeError, InputError)):
        written_whole(f"/dev/fd/{other}", write)
    os.close(other)
    assert os.read(one, 100) == b""
    os.close(one)


def test_a_text_that_is_not_utf_8_names_its_line():
    with pytest.raises(InputError, match=r"^t: line 3: is not UTF-8 text; save it as UTF-8$"):
        text_of(b"one\ntwo\n\xff", "t")


def test_a_trajectory_in_the_place_of_a_text_is_named_as_what_it_is(tmp_path):
    np.savez(path := tmp_path / "run.npz", q=np.zeros(3))
    for reader in (toml_read, json_read):
        with pytest.raises(InputError, match=r"run\.npz: is a ZIP archive, as a trajectory is"):
            reader(path)


READERS = {
    "TOML": toml_read,
    "JSON": json_read,
    "XML": loaded_urdf,
    "ZIP": load_trajectory,
}
SPOILERS = {
    "missing": (lambda path: None, "no such file"),
    "a folder": (lambda path: path.mkdir(), "cannot be read: Is a directory"),
    "a pipe": (os.mkfifo, "it is a device or a pipe, not a file"),
    "a device without end": (lambda path: path.symlink_to("/dev/zero"), "a device or a pipe"),
    "too large": (lambda path: (path.touch(), os.truncate(path, 2**30)), r"is larger than \d+ MiB"),
}


@cases("read", READERS)
@cases("spoil, words", SPOILERS)
def test_a_path_that_is_no_file_is_refused(tmp_path, read, spoil, words):
    path = tmp_path / "input"
    spoil(path)
    with refusal(InputError, f"{path}: ", words):
        read(path)


DEEP = 100_000
CONTENTS = {
    # name: reader, content, words of the sentence
    "TOML without end": (toml_read, b"a = " + b"[" * DEEP, "nested too deeply"),
    "JSON without end": (json_read, b"[" * DEEP + b"]" * DEEP, "is not usable JSON: too deep"),
    "XML without end": (
        loaded_urdf,
        b"<a>" * 101 + b"</a>" * 101,
        "line 1: is nested deeper than 100",
    ),
    "a key without end": (
        toml_read,
        b"h = 1\n" + b"a." * DEEP + b"b = 1",
        "line 2: a key has more",
    ),
    "a table without end": (toml_read, b"[" + b"a . " * DEEP + b"b]", "line 1: a key has more"),
    "a quoted key without end": (
        toml_read,
        b"x = { " + b"'a'." * DEEP + b"b = 1 }",
        "line 1: a key",
    ),
    "a key of escaped quotes": (toml_read, rb'"\"".' * 1200 + b"b = 1", "line 1: a key has more"),
    "a key of escaped points": (toml_read, rb'"\".".' * 1200 + b"b = 1", "line 1: a key has more"),
    "a key of backslashes": (toml_read, rb'"\\".' * 1200 + b"b = 1", "line 1: a key has more"),
    "a key of one backslash": (toml_read, rb"'\'." * 1200 + b"b = 1", "line 1: a key has more"),
    "many digits in TOML": (toml_read, b"h = " + b"1" * 5000, "an unusable number"),
    "many digits in JSON": (json_read, b'{"h": ' + b"1" * 5000 + b"}", "a number too long"),
    "a field twice in TOML": (toml_read, b"h = 1\nh = 2\n", "is not TOML: Cannot overwrite"),
    "a field twice in JSON": (
        json_read,
        b'{"h": 1, "h": 2}',
        r"h: is given twice; leave one out \(got 2\)",
    ),
    "half a character": (json_read, b'{"format": "\\ud800"}', "holds half of a character"),
    "no trajectory": (load_trajectory, b"", "is not a trajectory written by this program"),
}


@cases("read, content, words", CONTENTS)
def test_a_file_that_is_something_else_is_refused(tmp_path, read, content, words):
    path = tmp_path / "input"
    path.write_bytes(content)
    with refusal(InputError, f"{path}: ", words):
        read(path)


def test_minus_zero_is_written_zero_at_any_depth():
    value = {"a": -0.0, "b": [-0.0, (np.float64(-0.0),)], "c": np.array([[-0.0, -1.0]])}
    text = json_text(value)
    assert text == '{"a": 0.0, "b": [0.0, [0.0]], "c": [[0.0, -1.0]]}'


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, np.array([1.0, math.nan])])
def test_nan_and_infinity_are_not_written(value):
    with pytest.raises(ValueError, match="not JSON compliant"):
        json_text({"a": value})
