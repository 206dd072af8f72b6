"""Sweeps of simulation parameters: each run is measured, whatever becomes of it."""

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.lab.study.file.sweeps import sweep_study
from quasistatic_ref.lab.study.measuring.sweep import sweep_run
from quasistatic_ref.lab.study.store.rows import table
from quasistatic_ref.lab.study.store.store import contents

HEAD = 'format = "quasistatic-ref/study"\nversion = 1\nkind = "sweep"\n'
SLIDE = """
[[sweeps]]
name = "slide"
scenario = "block_incline"
link = "smooth"
duration = 0.02
[sweeps.axes.mu]
fields = ["contacts.smooth.mu_v"]
values = [0.0, 0.3]
[sweeps.axes.h]
values = [0.01, 0.02]
"""


@pytest.fixture
def sweeps(tmp_path):
    def read(text, **changes):
        path = tmp_path / "study.toml"
        path.write_text(HEAD + text)
        return sweep_study(path, toml_read(path), **changes)

    return read


def test_a_sweep_is_every_combination_of_the_values(sweeps):
    (sweep,) = sweeps(SLIDE)
    points = [{"mu": mu, "h": h} for mu in (0.0, 0.3) for h in (0.01, 0.02)]
    assert sweep.points() == points
    assert "steps=1" in sweep.settings(points[1])


def test_a_quick_sweep_takes_the_ends_of_each_axis(sweeps):
    text = SLIDE.replace("[0.0, 0.3]", "[0.0, 0.1, 0.2, 0.3]")
    assert sweeps(text, quick=True)[0].points() == sweeps(SLIDE)[0].points()


@pytest.mark.parametrize("mu", [0.0, 0.3])
@pytest.mark.parametrize("h", [0.01, 0.02])
def test_a_sliding_block_travels_as_its_closed_form_says(sweeps, mu, h):
    """Step k slips d (1 - r^(k+1)), d = h^2 g (sin a - mu cos a), r = mu^2 / (1 + mu^2).

    It is then mu times its last slip above the slope: docs/derivations.md.
    """
    (sweep,) = sweeps(SLIDE)
    row, _ = sweep_run(sweep, {"mu": mu, "h": h})
    angle = np.radians(25)
    steps = round(0.02 / h)
    d = h**2 * 9.81 * (np.sin(angle) - mu * np.cos(angle))
    r = mu**2 / (1 + mu**2)
    slips = d * (1 - r ** np.arange(1, steps + 1))
    travel = np.hypot(slips.sum(), mu * slips[-1])
    measures = row["measures"]
    assert row["outcome"] == "done"
    assert measures["travel_mm"] == pytest.approx(1e3 * travel, rel=1e-9)
    assert measures["boundary_layer_um"] == pytest.approx(1e6 * mu * slips[-1], rel=1e-9, abs=1e-9)
    assert measures["rotation_deg"] < 1e-9
    assert (measures["steps"], measures["exact"]) == (steps, 1.0)


REACH = """
[[sweeps]]
scenario = "block_incline"
link = "smooth"
[sweeps.axes.reach]
fields = ["limits.reach"]
values = [100.0, 0.2063]
"""


def test_a_run_that_ends_early_is_a_row_too(sweeps):
    """The block starts at 0.20616 m from the origin and slides past 0.2063 m on its way down."""
    (sweep,) = sweeps(REACH)
    rows = [sweep_run(sweep, point)[0] for point in sweep.points()]
    assert [row["outcome"] for row in rows] == ["done", "ended_early"]
    assert [row["reason"] is None for row in rows] == [True, False]
    steps = [row["measures"]["steps"] for row in rows]
    assert steps[0] == 100
    assert 0 < steps[1] < 100


def test_a_sweep_runs_resumes_and_prints_a_table(tmp_path, capsys):
    path = tmp_path / "study.toml"
    path.write_text(HEAD + SLIDE.replace("[0.01, 0.02]", "[0.01]"))
    command = ["study", "run", str(path), "--out", str(tmp_path / "store"), "--jobs", "1"]
    assert main(command) == 0
    assert "2 runs (fast path), 0 of which ended early" in capsys.readouterr().out
    rows = contents(tmp_path / "store").rows
    assert [row["values"] for row in table(rows)] == [
        {"mu": 0.0, "h": 0.01},
        {"mu": 0.3, "h": 0.01},
    ]
    assert main(command) == 0  # nothing is run again
    assert contents(tmp_path / "store").rows == rows


BAD = {
    "a duration without end": (
        SLIDE.replace("duration = 0.02", "duration = 1e14"), "duration: mak",
    ),
    "no axes": (SLIDE.partition("[sweeps.axes.mu]")[0], "sweeps[0].axes: is missing"),
    "a field the scenario does not know": (
        SLIDE.replace("contacts.smooth.mu_v", "contacts.smooth.mu"), "contacts.smooth.mu",
    ),
    "an unknown scenario": (SLIDE.replace("block_incline", "block_inclne"), "block_incline"),
    "an unknown link": (SLIDE.replace('"smooth"', '"smoth"', 1), "smooth"),
    "a name twice": (SLIDE + SLIDE, "is given twice"),
}  # fmt: skip
"""What a schema cannot know; what it can is in test_spec_schema.py."""


@pytest.mark.parametrize("name", BAD)
def test_a_mistake_in_a_sweep_is_one_sentence(name, sweeps):
    text, says = BAD[name]
    with pytest.raises(InputError) as refused:
        sweeps(text)
    assert says in str(refused.value)
    assert "study.toml" in str(refused.value) or "block_incline" in str(refused.value)
