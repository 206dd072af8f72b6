"""The command repeats rows of the committed result, and refuses what is not usable."""

import csv
import json

import numpy as np
import pytest

from validation.tools.scripts import RESULTS


def test_the_command_repeats_committed_predictions(tmp_path, cli):
    asked = "validate reality --sets abs/rect1 --fraction 0.008 --jobs 1 --json --out"
    record = json.loads(cli(asked, tmp_path).out)
    assert json.loads((tmp_path / "reality.json").read_text()) == record
    committed = json.loads((RESULTS / "reality.json").read_text())
    ratio = committed["mu_omega_over_mu_v"]["abs/rect1"]
    assert record["mu_omega_over_mu_v"] == {"abs/rect1": pytest.approx(ratio, rel=1e-9)}
    own = read_rows(tmp_path / "reality.csv")
    assert list(own) == [("abs", "rect1", number) for number in ("0", "125", "250")]
    everything = read_rows(RESULTS / "reality.csv")
    for key, row in own.items():
        # Seven digits; the kinds of steps and of grips are the same.
        assert row == pytest.approx(everything[key], rel=2e-6)
    steps = np.sum([row[3:5] for row in own.values()], axis=0)
    assert [record["steps"][kind] for kind in ("exact", "enclosure")] == list(steps)
    assert record["pairs"]["abs/rect1"]["pushes"] == 3


def read_rows(path):
    """The rows of a file of predictions, by surface, shape and push."""
    _, *rows = csv.reader(path.read_text().splitlines())
    return {tuple(row[:3]): np.array(row[3:], dtype=float) for row in rows}


UNUSABLE = {
    "reality --cone elipsoid": "ellipsoid",
    "reality --fraction 0": "--fraction",
    "reality --fraction 0.001": "fewer than two pushes",
    "reality --jobs 0": "--jobs",
    "reality --sets abs/rekt1": "abs/rect1",
    "incline --fraction 0.1": "validate reality",
}


@pytest.mark.parametrize("command", UNUSABLE)
def test_a_folder_of_reality_that_is_not_usable_ends_in_one_sentence(
    tmp_path, monkeypatch, cli, command
):
    monkeypatch.chdir(tmp_path)
    said = cli("validate", command, status=2).err
    assert UNUSABLE[command] in said
    assert said.count("\n") == 1
