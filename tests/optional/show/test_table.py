"""A trajectory as attributes and as tables of pandas."""

import csv
import sys
from dataclasses import replace
from operator import attrgetter

import cvxpy as cp
import numpy as np
import pandas
import pytest

from quasistatic_ref import Extension, InputError, load_scenario, load_trajectory, rollout
from quasistatic_ref.files.trajectory import header_read, header_table
from quasistatic_ref.optional.show.table import table_written
from tests.closeness import assert_same
from tests.scenes import BALL, written_scenario
from tests.scenes import scene as scene_of


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    return written_scenario(tmp_path_factory.mktemp("scene"))


@pytest.fixture(scope="module")
def run(scene):
    return load_scenario(scene, fast=True).run()


def test_arrays_are_attributes_by_the_names_of_the_format(run):
    assert set(dir(run)) >= {*run.arrays, "wrench_on", "header", "steps"}
    assert run.phi is run.arrays["phi"]
    with pytest.raises(AttributeError, match=r"this trajectory has no 'phis'; did you mean 'phi'"):
        attrgetter("phis")(run)


def test_the_wide_table_has_a_row_a_step_and_a_column_a_number_by_name_and_unit(run):
    table = run.to_pandas()
    assert_same(table.index, run.t)
    assert table.index.name == "t [s]"
    pair = "floor(floor, ball/ball#0)"
    f_1, f_2, f_n, torque = run.forces[:, 0].T
    expected = {
        "rail/slide [m]": run.q[1:, 0], "ball.qw [-]": run.q[1:, 9],
        "delta_q ball/base.rz [rad]": run.delta_q[:, 7],
        "target rail/slide [m]": run.q_bar_a[:, 0],
        "digits [-]": run.digits, "worst residual [-]": run.worst_residual,
        f"{pair}.phi [m]": run.phi[:, 0], f"{pair}.normal force [N]": f_n,
        f"{pair}.friction [N]": np.hypot(f_1, f_2), f"{pair}.torque [N m]": np.abs(torque),
        "push(rail/plate#0, ball/ball#0).phi [m]": run.phi[:, 1],
    }  # fmt: skip
    for name, column in expected.items():
        assert_same(table[name], column)
    assert set(table["certificate"]) == {"exact"}
    # q 10, delta_q 8, q_bar_a 3; phi and three loads of 2 pairs; 3
    assert table.shape == (5, 10 + 8 + 3 + 2 * 4 + 3)


def test_run_writes_both_tables_as_csv_or_parquet(tmp_path, scene, cli):
    wide = tmp_path / "wide.parquet"
    tidy = tmp_path / "contacts.csv"
    said = cli("run --fast", scene, "--out", tmp_path, "--table", wide, "--contacts-table", tidy)
    assert f"and {wide} and {tidy}" in said.out
    run = load_trajectory(tmp_path / f"{scene.stem}.npz")
    table = pandas.read_parquet(wide)
    assert_same(table["ball.z [m]"], run.to_pandas()["ball.z [m]"])
    contacts = pandas.read_csv(tidy, dtype=str)  # before 3 it reads numbers wrong by a last bit
    assert contacts["pair"].tolist() == run.pair_names * run.steps
    for name, numbers in (("phi [m]", run.phi), ("f_n [N]", run.forces[:, :, 2])):
        assert_same(contacts[name].astype(float), numbers.ravel())


def test_a_name_is_no_formula_in_a_table(tmp_path):
    """Spreadsheets take a cell for one that begins with one of these; Parquet has no formulas."""
    names = [f"{begin}1+1" for begin in "=+-@"]
    ball = {"urdf": BALL, "base": "floating", "pose": {"xyz": [0, 0, 0.05]}}
    contacts = {name: ("floor", name, 0.5, 1) for name in names}
    run = scene_of(dict.fromkeys(names, ball), contacts, 1, fast=True).run()
    for option in ("--table", "--contacts-table"):
        text = table_written(run, tmp_path / "t.csv", option).read_text()
        cells = [cell for line in csv.reader(text.splitlines()) for cell in line]
        assert not [cell for cell in cells if cell.startswith(tuple("=+@"))]
        assert all(any(cell.startswith(f"'{name}") for cell in cells) for name in names)


def test_a_table_of_another_kind_is_refused_before_the_run(tmp_path, scene, cli):
    assert (
        "--table: must end in .csv or .parquet (got 'table.xls')"
        in cli("run", scene, "--out", tmp_path, "--table table.xls", status=2).err
    )
    assert not list(tmp_path.glob("*.npz"))


WRENCH = ("f_d1 {}[N]", "f_d2 {}[N]", "f_n {}[N]", "tau_n {}[N m]")


@pytest.mark.parametrize("record", ["light", "forces", "full"])
def test_columns_of_what_is_not_unique_say_so(scene, record):
    """A light record holds lam alone, of which forces on a patch are one of many answers."""
    run = load_scenario(scene, {"record": record}, fast=True).run()
    shown, word = (run.wrench, "of lam ") if record == "light" else (run.forces, "")
    _check_wrenches(run, shown, word)


def test_a_step_that_is_not_all_that_was_solved_has_the_columns_of_lam(scene):
    """With a cone among its rows, a full record refuses forces as a light one does."""
    scenario = load_scenario(scene, {"record": "full"})
    cone = Extension(lambda s: [cp.norm(s.delta_q_a) <= 1e-3])
    simulator = scenario.simulator(extension=lambda q: cone)
    run = rollout(simulator, scenario.system.q_start, scenario.targets, 2, progress=False)
    with pytest.raises(InputError, match="are not known: a step holds no costs or nonlinear"):
        run.pair_forces()
    _check_wrenches(run, run.wrench, "of lam ")


def _check_wrenches(run, shown, word):
    """The table has these wrenches, (steps, n_c, 4) [N, N m], by names with this word alone."""
    table = run.contacts_to_pandas()
    names = [name.format(word) for name in WRENCH]
    assert [name for name in table if name.startswith(("f_", "tau_n"))] == names
    assert_same(table[names].to_numpy().reshape(shown.shape), shown)


def test_files_without_names_have_numbers(run):
    names = ("positions", "slots", "units", "scene")
    table = {name: words for name, words in header_table(run.header).items() if name not in names}
    plain = replace(run, header=header_read(table, run.arrays))
    assert list(plain.contacts_to_pandas()["pair"][:2]) == ["contact/0", "contact/1"]
    assert_same(plain.to_pandas()["q.0 [m, rad]"], run.q[1:, 0])


@pytest.mark.parametrize(
    ("name", "changes", "steps"), [("sphere_spin", {}, 0), ("arm_push", {"contacts": {}}, 2)]
)
def test_a_run_without_steps_or_contacts_has_an_empty_table_of_contacts(run, name, changes, steps):
    other = load_scenario(name, changes, steps=steps, fast=True).run()
    assert len(other.to_pandas()) == steps
    table = other.contacts_to_pandas()
    assert len(table) == 0
    if steps:  # without, what is measured has no columns
        assert list(table.columns) == list(run.contacts_to_pandas().columns)


def test_without_pandas_a_table_is_one_sentence(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(InputError, match=r"^a table needs pandas: pip install 'quasistatic"):
        run.to_pandas()
