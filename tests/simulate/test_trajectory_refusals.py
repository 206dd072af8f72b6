"""What is no trajectory, or holds what none can hold, is refused in a sentence."""

import json

import numpy as np
import pytest

from quasistatic_ref.errors import InputError
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.simulate.trajectory import trajectory_read
from tests.scenes import written_scenario


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return load_scenario(written_scenario(tmp_path_factory.mktemp("scenes"))).run(progress=False)


def array_changed(path, name, values):
    """The same file with a number in the middle of an array, or with another array."""
    with np.load(path) as file:
        arrays = {key: file[key] for key in file.files}
    if name in arrays:
        arrays[name].flat[arrays[name].size // 2] = values
    else:
        arrays[name] = values
    np.savez(path, **arrays)


def header_changed(path, change):
    """The same file with another header."""
    with np.load(path) as file:
        arrays = {name: file[name] for name in file.files}
    header = json.loads(arrays["header"].tobytes())
    change(header)
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    np.savez(path, **arrays)


NOT_ONE = "is not a trajectory written by this program"
SPOILT = {
    "empty": (lambda p: p.write_bytes(b""), NOT_ONE),
    "text": (lambda p: p.write_text("t, q\n0, 1\n"), NOT_ONE),
    "truncated": (lambda p: p.write_bytes(p.read_bytes()[:-100]), NOT_ONE),
    "a bare array": (lambda p: np.save(p.open("wb"), np.zeros(3)), NOT_ONE),
    "a pickle in it": (lambda p: np.savez(p, header=np.array([{}], dtype=object)), NOT_ONE),
    "a header that is a list": (
        lambda p: np.savez(p, header=np.frombuffer(b"[]", dtype=np.uint8)),
        "must be a table of named fields",
    ),
    "another format": (
        lambda p: header_changed(p, lambda h: h.update(format="quasistatic-ref/step")),
        "format: must be 'quasistatic-ref/trajectory'",
    ),
    "no cone": (lambda p: header_changed(p, lambda h: h.pop("cone")), "cone: is missing"),
    "an unknown field": (
        lambda p: header_changed(p, lambda h: h.update(step=5)),
        "step: is unknown; did you mean 'steps'?",
    ),
    "a coordinate less": (
        lambda p: header_changed(p, lambda h: h["coordinates"].pop()),
        "coordinates: must have 8 entries",
    ),
    "an unknown array": (
        lambda p: array_changed(p, "ph", np.zeros(5)),
        "ph: is unknown; did you mean 'phi'?",
    ),
    "NaN in q": (lambda p: array_changed(p, "q", np.nan), "q: must contain finite numbers only"),
    "infinity in phi": (
        lambda p: array_changed(p, "phi", np.inf),
        "phi: must contain finite numbers only",
    ),
    "no array of positions": (
        lambda p: np.savez(p, header=np.load(p)["header"], t=np.zeros(1)),
        "has no array named 'delta_q'",
    ),
}


@pytest.mark.filterwarnings("ignore::ResourceWarning")  # of the spoilers, not of the reader
@pytest.mark.parametrize(("spoil", "says"), SPOILT.values(), ids=SPOILT)
def test_what_is_not_a_trajectory_is_refused_in_words(tmp_path, run, spoil, says):
    path = run.save(tmp_path / "run.npz")
    spoil(path)
    with pytest.raises(InputError) as caught:
        trajectory_read(path)
    assert str(caught.value).startswith(f"{path}: {says}")


def test_a_missing_file_is_refused_in_words(tmp_path):
    with pytest.raises(InputError, match=r"none\.npz: no such file"):
        trajectory_read(tmp_path / "none.npz")


def test_flipped_bits_are_refused_in_words_or_change_nothing_unseen(tmp_path, run):
    path, flips = run.save(tmp_path / "run.npz"), np.random.default_rng(3)
    content, refusals = bytearray(path.read_bytes()), []
    for _ in range(60):
        spoilt = bytearray(content)
        spoilt[flips.integers(len(content))] ^= 1 << flips.integers(8)
        path.write_bytes(spoilt)
        try:
            trajectory_read(path)
        except InputError as refused:
            refusals.append(str(refused))
    assert refusals
    assert not [words for words in refusals if not words.startswith(str(path))]
