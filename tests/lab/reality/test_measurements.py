"""The measurements that come with the package, and how far predictions are from them."""

import json

import numpy as np
import pytest

from quasistatic_ref.lab.folders import reality_folder
from quasistatic_ref.lab.reality.errors import pose_errors
from quasistatic_ref.lab.reality.measurements import Loads, loads_read, pairs_read, pushes_read
from quasistatic_ref.lab.reality.report import certified_words


@pytest.mark.parametrize("name", ["patches", "loads", "pushes"])
def test_the_data_package_names_the_columns_of_a_file(name):
    package = json.loads((reality_folder() / "datapackage.json").read_text())
    (resource,) = [r for r in package["resources"] if r["path"] == f"{name}.csv"]
    head, _ = (reality_folder() / f"{name}.csv").read_text().split("\n", 1)
    names = [field["name"] for field in resource["schema"]["fields"]]
    assert sorted(names) == sorted(head.split(","))


def test_the_committed_data_are_whole():
    pairs = pairs_read()
    assert len(pairs) == 18
    assert all(pair.outline.area > 0 for pair in pairs)
    assert sum(len(pushes.before) for pushes in pushes_read(pairs).values()) == 5374
    assert sum(len(loads.wrench) for loads in loads_read(pairs).values()) == 9327


def test_a_load_means_the_same_about_another_point(rng):
    # Power does not depend on the point of reference: f . v + tau omega.
    own = Loads(rng.normal(size=(20, 3)), rng.normal(size=(20, 3)))
    other = own.about(np.array([0.3, -0.2]))
    power = [np.einsum("ij,ij->i", x.wrench, x.twist) for x in (own, other)]
    assert power[0] == pytest.approx(power[1])


def test_errors_of_angles_are_taken_the_short_way_round():
    found = pose_errors(np.array([[3.0, 4.0, 3.1]]), np.array([[0.0, 0.0, -3.1]]))
    assert found[0] == pytest.approx([5.0, 2 * np.pi - 6.2])


def test_steps_without_an_error_bound_are_said():
    record = {"steps": {"exact": 1, "residual": 1}, "largest_error_bound": None}
    assert certified_words(record) == "2 steps: 1 exact, 1 residual; some have no error bound"
