"""Trajectory files that cannot be used: spoilt, pickled, blown up, or at odds with themselves."""

import io
import json
import struct
import zipfile

import numpy as np
import pytest

from quasistatic_ref import load_scenario, save_trajectory
from tests.cases import cases
from tests.errors.scene import scene_written

NOT_ONE = "is not a trajectory written by this program"


def zip_bytes(members, pack=zipfile.ZIP_STORED):
    """Members as a ZIP file whose checksums are right."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", pack) as archive:
        for name, content in members:
            archive.writestr(name, content, pack)
    return file.getvalue()


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The bytes of a good trajectory of three steps."""
    folder = tmp_path_factory.mktemp("run")
    scenario = load_scenario(scene_written(folder))
    return save_trajectory(folder / "run.npz", scenario.run()).read_bytes()


def npy(array, shape=None, pickled=False):
    """An array file, whose header may lie about its shape."""
    file = io.BytesIO()
    np.lib.format.write_array(file, array, allow_pickle=pickled)
    content = file.getvalue()
    if shape is None:
        return content
    line = content.index(b"\n")
    old = str(array.shape).encode()
    assert old in content[:line]
    return content[:line].replace(old, shape.encode()).rstrip().ljust(line) + content[line:]


def rewritten(run, changes):
    """The archive with members replaced; a mapping in the place of one has fields of the header."""
    with zipfile.ZipFile(io.BytesIO(run)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    for name, content in changes.items():
        if isinstance(content, dict):
            record = json.loads(members["header.npy"][128:]) | content
            content = npy(np.frombuffer(json.dumps(record).encode(), dtype=np.uint8))
        members[f"{name}.npy"] = content
    return zip_bytes(members.items())


def bomb(_):
    """A member that claims 3 GiB, and holds very many zeros, in few bytes."""
    content = bytearray(zip_bytes([("t.npy", bytes(2**20))], zipfile.ZIP_DEFLATED))
    at = content.find(b"PK\x01\x02")
    content[at + 24 : at + 28] = (3 * 2**30).to_bytes(4, "little")
    return bytes(content)


def twice(run):
    """The archive with its array t twice; readers differ in which of the two they take."""
    file = io.BytesIO(run)
    with zipfile.ZipFile(file, "a") as archive:
        archive.writestr("t.npy", npy(ZEROS))
    return file.getvalue()


def lzma_spoilt(_):
    """A member whose compressed bytes are zeros."""
    content = bytearray(zip_bytes([("t.npy", npy(np.zeros(100)))], zipfile.ZIP_LZMA))
    content[50:60] = bytes(10)
    return bytes(content)


def far_away(run):
    """The first member begins at byte 2^64 - 1, which the directory has room for."""
    start, end = run.index(b"PK\x01\x02"), run.index(b"PK\x05\x06")
    extra = struct.pack("<HHQ", 1, 8, 2**64 - 1)
    entry = bytearray(run[start:end])
    name = int.from_bytes(entry[28:30], "little")
    entry[30:32] = struct.pack("<H", len(extra))
    entry[42:46] = b"\xff" * 4
    entry[46 + name : 46 + name] = extra
    last = bytearray(run[end:])
    last[12:16] = struct.pack("<I", len(entry))
    return run[:start] + entry + last


ZEROS = np.zeros(3)
CAUSES = {
    # name: (what is replaced in the good one, or the file from it, words of the sentence)
    "a name of several lines": (
        lambda run: rewritten(run, {}).replace(b"header.npy", b"he\n\x1b[2J.np"),
        f"he\\n\\x1b[2J.np: {NOT_ONE}",
    ),
    "a pickle": (
        {"t": npy(np.array([{}]), pickled=True)},
        f"{NOT_ONE}: t.npy is a pickle, which is never opened",
    ),
    "a bomb": (bomb, "its arrays: unpack to more than 1 GiB (got 3221225472)"),
    "an array twice": (twice, "t.npy: is given twice"),
    "a spoilt member of LZMA": (lzma_spoilt, NOT_ONE),
    "a member that begins beyond any file": (far_away, NOT_ONE),
    "very many members": (
        {f"x{i}": b"" for i in range(300)},
        "holds more than 256 arrays (got ",
    ),
    "an array that says it is vast": (
        {"t": npy(ZEROS, "(99999999999,)")},
        f"{NOT_ONE}: t.npy does not have the size that it says",
    ),
    "a header of code": (
        {"t": npy(ZEROS, "open('x','w')")}, NOT_ONE,
    ),
    "a header without end": (
        {"header": npy(np.full(100_000, 91, dtype=np.uint8))},
        f"{NOT_ONE}: its header is not JSON",
    ),
    "an earlier version": ({"header": {"version": 1}}, "reads 2 (got 1)"),
    "a later version": ({"header": {"version": 3}}, "reads 2 (got 3)"),
    "a coordinate less": (
        {"header": {"coordinates": ["x"]}}, "coordinates: must have ",
    ),
    "an unknown array": (
        {"ph": npy(ZEROS)}, "ph: is unknown; did you mean 'phi'?",
    ),
    "a position without an axis": (
        {"q": npy(np.array(1.0))}, "q: must have an entry a step, not",
    ),
    "NaN in phi": (
        {"phi": npy(np.full((3, 2), np.nan))}, "phi: must contain fin",
    ),
    "more steps than there are": (
        {"header": {"steps": 4}}, "q: must have 5 entries, as the header",
    ),
    "rows of an extension that are not there": (
        {"header": {"extra": ["a"]}}, "has no array named 'lam_extra'",
    ),
}  # fmt: skip


@pytest.mark.filterwarnings("ignore:Duplicate name")
@cases("spoilt, words", CAUSES)
def test_a_trajectory_that_cannot_be_used_is_refused(tmp_path, refused, run, spoilt, words):
    path = tmp_path / "run.npz"
    path.write_bytes(spoilt(run) if callable(spoilt) else rewritten(run, spoilt))
    sentence = refused("extract", path, "--step", 1, "-o", tmp_path / "step.json")
    assert sentence.startswith(f"{path}: ")
    assert words in sentence


@pytest.mark.parametrize("k", [-1, 3, 10**30])
def test_a_step_that_a_run_does_not_have_is_refused(tmp_path, refused, run, k):
    (tmp_path / "run.npz").write_bytes(run)
    sentence = refused("extract", tmp_path / "run.npz", "--step", k)
    assert sentence.startswith(f"--step {k}: must be 0 to 2")
