"""Sweeps of simulation parameters: each run is measured, whatever becomes of it."""

from dataclasses import replace

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.study.measuring.sweep import Axis, Sweep, sweep_run

MU = Axis("mu", ("contacts.smooth.mu_v",), (0.0, 0.3))
SLIDE = Sweep("slide", "block_incline", 0.02, (MU, Axis("h", ("h",), (0.01, 0.02))))


def test_a_sweep_is_every_combination_of_the_values():
    points = [{"mu": mu, "h": h} for mu in (0.0, 0.3) for h in (0.01, 0.02)]
    assert SLIDE.points() == points
    assert "steps=1" in SLIDE.settings(points[1])


@pytest.mark.parametrize("mu", [0.0, 0.3])
@pytest.mark.parametrize("h", [0.01, 0.02])
def test_a_sliding_block_travels_as_its_closed_form_says(mu, h):
    """Step k slips d (1 - r^(k+1)), d = h^2 g (sin a - mu cos a), r = mu^2 / (1 + mu^2).

    It is then mu times its last slip above the slope: docs/derivations.md.
    """
    row, _ = sweep_run(SLIDE, {"mu": mu, "h": h})
    angle = np.radians(25)
    steps = round(0.02 / h)
    d = h**2 * 9.81 * (np.sin(angle) - mu * np.cos(angle))
    r = mu**2 / (1 + mu**2)
    slips = d * (1 - r ** np.arange(1, steps + 1))
    travel = np.hypot(slips.sum(), mu * slips[-1])
    measures = row["measures"]
    assert row["outcome"] == "done"
    assert measures["smooth.ends_from_start_m"] == pytest.approx(travel, rel=1e-9)
    assert measures["boundary_layer_um"] == pytest.approx(1e6 * mu * slips[-1], rel=1e-9, abs=1e-9)
    assert measures["smooth.largest_rotation_deg"] < 1e-9
    assert (measures["steps"], measures["exact"]) == (steps, 1.0)


def test_a_run_that_ends_early_is_a_row_too():
    """The block starts at 0.20616 m from the origin and slides past 0.2063 m on its way down."""
    reach = Axis("reach", ("limits.reach",), (100.0, 0.2063))
    sweep = replace(SLIDE, duration=None, axes=(reach,))
    rows = [sweep_run(sweep, point)[0] for point in sweep.points()]
    assert [row["outcome"] for row in rows] == ["done", "ended_early"]
    assert [row["reason"] is None for row in rows] == [True, False]
    steps = [row["measures"]["steps"] for row in rows]
    assert steps[0] == 100
    assert 0 < steps[1] < 100


def test_a_duration_without_end_is_refused():
    with pytest.raises(InputError, match="duration: makes more than"):
        replace(SLIDE, duration=1e14).settings({"mu": 0.0, "h": 0.01})
