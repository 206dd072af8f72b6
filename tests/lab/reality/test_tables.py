"""Files of measurements: their schema, and one sentence for what is not usable."""

import json
import shutil

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.folders import reality_folder
from quasistatic_ref.lab.reality import loads, pairs, pushes
from quasistatic_ref.lab.reality.errors import bootstrap_estimate, pose_errors
from quasistatic_ref.lab.reality.report import certified_words

HEAD = "surface,shape,push,x0,y0,theta0,x1,y1,theta1,tip_x0,tip_y0,tip_x1,tip_y1"
SCHEMA = {
    "patches.csv": (pairs.COLUMNS, pairs.OPTIONAL),
    "loads.csv": (loads.COLUMNS, {}),
    "pushes.csv": (pushes.COLUMNS, pushes.OTHERS),
}


@pytest.fixture
def folder(tmp_path):
    for name in ("patches.csv", "shapes.json"):
        shutil.copy(reality_folder() / name, tmp_path / name)
    return tmp_path


@pytest.mark.parametrize("file", SCHEMA)
def test_the_data_package_names_the_columns_that_are_read(file):
    package = json.loads((reality_folder() / "datapackage.json").read_text())
    (resource,) = [r for r in package["resources"] if r["path"] == file]
    fields = resource["schema"]["fields"]
    required, optional = SCHEMA[file]
    assert [f["name"] for f in fields] == ["surface", "shape", *required, *optional]
    musts = [f["name"] for f in fields if f.get("constraints", {}).get("required")]
    assert musts == list(required)


def test_the_committed_data_are_whole():
    own = pairs.pairs_read(reality_folder())
    found = pushes.pushes_read(reality_folder(), own)
    assert len(own) == 18
    assert sum(p.number.size for p in found.values()) == 5374
    assert sum(len(x.wrench) for x in loads.loads_read(reality_folder(), own).values()) == 9327


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "line of column names"),
        (HEAD.replace(",x0", "") + "\nabs,hex,0" + ",0" * 9, "column x0: is missing"),
        (HEAD + ",x2\nabs,hex,0" + ",0" * 11, "column x2: is unknown"),
        (HEAD + "\nabs,hex,0" + ",0" * 9, "line 2: must have 13 entries"),
        (HEAD + "\nabs,hex,0,nan" + ",0" * 9, "line 2, column x0: must be a finite number"),
        (HEAD + "\nabs,rect1,0" + ",0" * 10, "abs/hex: has no pushes"),
        (HEAD + ("\nabs,hex,0" + ",0" * 10) * 2, "each once"),
    ],
)
def test_a_table_that_is_not_usable_is_refused_in_a_sentence(folder, text, says):
    (folder / "pushes.csv").write_text(text)
    with pytest.raises(InputError, match=says) as error:
        pushes.pushes_read(folder, pairs.pairs_read(folder, ["abs/hex"]))
    assert "\n" not in str(error.value)


def test_a_load_means_the_same_about_another_point():
    # Power does not depend on the point of reference: f . v + tau omega.
    rng = np.random.default_rng(0)
    own = loads.Loads(rng.normal(size=(20, 3)), rng.normal(size=(20, 3)))
    other = own.about(np.array([0.3, -0.2]))
    power = [np.einsum("ij,ij->i", x.wrench, x.twist) for x in (own, other)]
    assert power[0] == pytest.approx(power[1])
    # A force along x at the new point has no torque about it.
    one = loads.Loads(np.array([[1.0, 0.0, 0.2]]), np.zeros((1, 3)))
    assert one.about(np.array([0.3, -0.2])).wrench[0, 2] == pytest.approx(0.0)


def test_errors_of_angles_are_taken_the_short_way_round():
    found = pose_errors(np.array([[3.0, 4.0, 3.1]]), np.array([[0.0, 0.0, -3.1]]))
    assert found[0] == pytest.approx([5.0, 2 * np.pi - 6.2])


def test_a_bootstrap_interval_is_that_of_the_mean():
    # The mean of n numbers of standard deviation s has that of s / sqrt(n).
    rng = np.random.default_rng(1)
    groups = [rng.normal(2.0, 1.0, size=(400, 1)), rng.normal(4.0, 1.0, size=(400, 1))]
    found = bootstrap_estimate(groups)
    width = 2 * 1.96 / np.sqrt(800)
    assert found.mean[0] == pytest.approx(3.0, abs=0.15)
    assert found.high[0] - found.low[0] == pytest.approx(width, rel=0.15)


def test_steps_without_an_error_bound_are_said():
    record = {"steps": {"exact": 1, "residual": 1}, "largest_error_bound": None}
    assert certified_words(record) == "2 steps: 1 exact, 1 residual; some have no error bound"
