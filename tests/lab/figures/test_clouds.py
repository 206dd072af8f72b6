"""The committed study of clouds: its rows are whole; another cloud takes one command."""

from collections import Counter

import numpy as np
import trimesh

from quasistatic_ref.files.resources import scenario_path
from quasistatic_ref.lab.figures.clouds import TURNS, margin, rows
from quasistatic_ref.lab.sweep import simulate_many
from tests.closeness import assert_relative

SAMPLINGS = ("random", "farthest", "vertices", "scan")


def test_every_cell_of_the_grid_has_its_thirty_seeds():
    cells = Counter(
        tuple(row[name] for name in ("sampling", "count", "change", "value", "mu_omega"))
        for row in rows()
    )
    assert set(cells.values()) == {30}
    # 16 densities and 17 changes with and without torsion; 5 values of mu_omega.
    assert len(cells) == 16 * 2 + 17 * 2 + 5
    assert {cell[:2] for cell in cells} == {
        (sampling, count) for sampling in SAMPLINGS for count in (200, 992, 10_000, 100_000)
    }


def test_a_grip_whose_numbers_are_known_has_the_margin_of_r14():
    """(R14): needed = l / (2 N / W - 1 / mu_v), W = m (g + v / h)."""
    for one in rows()[::97]:
        if one.get("needed") is None:
            continue
        weight = 0.2 * (9.81 + 0.04 / 2.2 / 0.01)
        needed = one["lever"] / (2 * one["squeeze"] / weight - 1 / 0.6)
        assert_relative(one["needed"], needed, 1e-4)
        assert_relative(margin(one) * needed, one["mu_omega"] + one["spread"], 1e-4)


def test_a_cloud_of_ones_own_is_grasped_by_a_sweep(tmp_path):
    """As docs/reality.md says: of random points of the same mesh."""
    mesh = trimesh.load_mesh(scenario_path("bunny_grasp").with_name("bunny.obj"))
    points, _ = trimesh.sample.sample_surface(mesh, 992, seed=0)
    cloud = tmp_path / "cloud.csv"
    np.savetxt(cloud, points, delimiter=",", header="x,y,z", comments="")
    varied = {"bodies.bunny.cloud": [str(cloud)], "contacts.grip.mu_omega": [0.0, 0.003]}
    varied["solver.certify"] = ["off"]
    made = simulate_many("bunny_grasp", varied, tmp_path / "clouds", workers=1)
    without, torsion = (row["measures"]["bunny.largest_rotation_deg"] for row in made)
    assert torsion < TURNS < without
