"""The release command knows every committed result, and says how each differs from its commit."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from matplotlib import image

from validation.tools import remade
from validation.tools.release import RESULTS

ROOT = Path(__file__).parents[2]
# Written by a person who judged what was found, not by a command.
BY_HAND = {"validation/results/mutation_survivors.md", "validation/results/ports.md"}


def committed():
    folders = ("validation/results/*", "validation/results/figures/*.png", "docs/figures/*.png")
    folders = (*folders, "validation/*.md", "validation/results/benchmarks/*")
    return {str(p.relative_to(ROOT)) for folder in folders for p in ROOT.glob(folder)}


def test_every_committed_result_has_a_command():
    written = [path for result in RESULTS for path in result.writes]
    orphans = {
        name for name in committed() - BY_HAND if not any(name.startswith(w) for w in written)
    }
    assert orphans == set()
    assert len(committed()) > 15


def test_the_four_kinds_of_result_are_made_where_their_commands_exist():
    known = {result.name: result.available for result in RESULTS}
    assert known["claims"]
    assert known["figures"]
    vectors = (ROOT / "quasistatic_ref" / "lab" / "commands" / "vectors.py").exists()
    assert known["vectors"] == vectors


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A repository with two committed files, a table and a picture."""
    monkeypatch.setattr(remade, "ROOT", tmp_path)
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "table.txt").write_text("one\ntwo\n")
    image.imsave(tmp_path / "results" / "picture.png", np.zeros((4, 5, 3)))
    who = ("-c", "user.name=a", "-c", "user.email=a@b")
    for command in (("init", "-q"), ("add", "."), (*who, "commit", "-q", "-m", "results")):
        subprocess.run(["git", *command], cwd=tmp_path, check=True)
    return tmp_path / "results"


def test_what_is_as_committed_is_not_listed(repository):
    (repository / "table.txt").write_text("one\ntwo\n")
    assert remade.changes(("results",)) == []


def test_a_picture_of_the_same_pixels_in_other_bytes_is_not_listed(repository):
    picture = repository / "picture.png"
    before = picture.read_bytes()
    image.imsave(picture, np.zeros((4, 5, 3)), metadata={"Title": "another"})
    assert picture.read_bytes() != before
    assert remade.changes(("results",)) == []


def test_changes_are_listed_by_file(repository):
    pixels = np.zeros((4, 5, 3))
    pixels[0, 0] = 1.0  # one of twenty
    image.imsave(repository / "picture.png", pixels)
    (repository / "table.txt").write_text("one\nthree\nfour\n")
    (repository / "more.txt").write_text("")
    assert sorted(remade.changes(("results",))) == [
        "results/more.txt: new",
        "results/picture.png: 5.00 % of its pixels differ",
        "results/table.txt: 1 lines are now 2 others",
    ]


def test_a_file_that_is_gone_and_a_picture_of_another_size_are_listed(repository):
    image.imsave(repository / "picture.png", np.zeros((4, 6, 3)))
    (repository / "table.txt").unlink()
    assert sorted(remade.changes(("results",))) == [
        "results/picture.png: 5 x 4 pixels are now 6 x 4",
        "results/table.txt: gone",
    ]
