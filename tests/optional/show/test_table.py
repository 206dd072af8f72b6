"""A trajectory as attributes, as a sequence of steps, and as a table of pandas."""

import sys
from operator import attrgetter

import numpy as np
import pandas
import pytest

from quasistatic_ref.errors import InputError
from quasistatic_ref.scenario.scenario import load_scenario
from quasistatic_ref.simulate.trajectory import Trajectory
from tests.scenes import written_scenario


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return load_scenario(written_scenario(tmp_path_factory.mktemp("scene")), fast=True).run(
        progress=False
    )


def test_arrays_are_attributes_by_the_names_of_the_format(run):
    for name, array in run.arrays.items():
        assert getattr(run, name) is array
    assert set(dir(run)) >= {*run.arrays, "wrench_on", "header", "steps"}
    with pytest.raises(AttributeError, match=r"this trajectory has no 'phis'; did you mean 'phi'"):
        attrgetter("phis")(run)
    assert not hasattr(run, "lam_extra")


def test_the_length_is_that_in_steps_and_an_empty_run_is_a_run(run):
    assert len(run) == run.steps == 5
    empty = Trajectory(run.header, {"t": np.zeros(0)})
    assert len(empty) == 0
    assert empty


def test_a_table_has_a_row_a_step_and_a_column_a_number(run):
    table = run.to_pandas()
    assert isinstance(table, pandas.DataFrame)
    np.testing.assert_array_equal(table.index, run.t)
    assert table.index.name == "t"
    expected = {
        "q.0": run.q[1:, 0], "q.9": run.q[1:, 9],
        "delta_q.rail/slide": run.delta_q[:, 0], "delta_q.ball/base.rz": run.delta_q[:, 7],
        "q_bar_a.2": run.q_bar_a[:, 2], "phi.1": run.phi[:, 1], "alpha.0.y": run.alpha[:, 0, 1],
        "n.1.x": run.n[:, 1, 0], "wrench.0.f_n": run.wrench[:, 0, 2],
        "wrench.1.tau_n": run.wrench[:, 1, 3], "lam.9": run.lam[:, 9], "point.0": run.point[:, 0],
        "digits": run.digits, "worst_residual": run.worst_residual,
    }  # fmt: skip
    for name, column in expected.items():
        np.testing.assert_array_equal(table[name], column)
    assert set(table["certificate"]) == {"exact"}
    # q 10, delta_q 8, q_bar_a 3, phi 2, five vectors of 2 contacts, point 2, wrench 8, lam 10, 3
    assert table.shape == (5, 10 + 8 + 3 + 2 + 5 * 2 * 3 + 2 + 2 * 4 + 10 + 3)


def test_a_run_without_steps_is_an_empty_table(run):
    empty = load_scenario("sphere_spin", steps=0, fast=True).run(progress=False)
    assert len(empty.to_pandas()) == 0


def test_without_pandas_a_table_is_one_sentence(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(InputError, match=r"^a table needs pandas: pip install 'quasistatic"):
        run.to_pandas()
