"""Bodies from scans: mass properties against their solids', strays, units, what is refused."""

from contextlib import nullcontext
from itertools import product

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree

import quasistatic_ref as qr
from quasistatic_ref import InputError
from quasistatic_ref.files.clouds import KINDS as CLOUDS
from quasistatic_ref.files.clouds import point_cloud
from quasistatic_ref.files.mesh_files import MESHES
from quasistatic_ref.optional.scans.cloud import thinned
from tests.closeness import assert_relative, assert_within
from tests.oracles.scanned import SCANS, SOLIDS, on_surface
from tests.pages import ROOT

WITHIN, WITH_NOISE = 0.01, 0.10
"""Errors of mass properties that are asked for, over the extent or the largest moment."""
MASS = 0.35
BUNNY = ROOT / "models" / "bunny_grasp"
CUBE = trimesh.creation.box((0.1, 0.1, 0.1))


def body(folder, points, **more):
    path = folder / "scan.npy"
    np.save(path, points)
    return qr.scanned_body(path, **{"mass": MASS, "name": "thing", **more})


def off(made, solid):
    """Largest error of centre and inertia, over the extent and the largest moment [-]."""
    gyration = solid.moment_inertia / solid.volume
    extent = np.ptp(made.points, axis=0).max()
    moments = abs(made.inertia / MASS - gyration).max() / np.linalg.eigvalsh(gyration).max()
    return float(max(np.linalg.norm(made.centre - solid.center_mass) / extent, moments))


EACH = [
    pytest.param(solid, scan, marks=() if i == j else pytest.mark.long)
    for i, solid in enumerate(SOLIDS)
    for j, scan in enumerate(SCANS)
]
"""README's line takes every solid and every scan once."""


@pytest.mark.parametrize(("solid", "scan"), EACH)
def test_a_cloud_has_the_centre_and_inertia_of_the_hull_of_its_solid(solid, scan, tmp_path, rng):
    points = on_surface(SOLIDS[solid], 5000, seed=0)
    made = body(tmp_path, SCANS[scan](rng, points))
    assert off(made, SOLIDS[solid].convex_hull) < (WITH_NOISE if scan == "noisy" else WITHIN)
    assert made.mass == MASS
    assert len(made.points) == 1000
    said = [note for note in made.notes if "5 stray points are left out" in note]
    assert len(said) == (scan == "with strays")


def test_a_scan_that_is_no_thing_in_hand_is_asked_for_its_unit(tmp_path):
    points = on_surface(SOLIDS["can"], 3000, seed=1)
    for length, taken in ((0.0049, False), (0.0051, True), (2.9, True), (3.1, False)):
        scan = points * length / np.ptp(points, axis=0).max()
        with nullcontext() if taken else pytest.raises(InputError, match="say its unit"):
            body(tmp_path, scan)
    with pytest.raises(InputError, match="is 115 m long if it is in metres; say its unit: --unit"):
        body(tmp_path, 1e3 * points)
    assert off(body(tmp_path, 1e3 * points, unit="mm"), SOLIDS["can"]) < WITHIN
    with pytest.raises(InputError, match="unit: is not a unit; did you mean 'mm'"):
        body(tmp_path, points, unit="mmm")


def test_a_closed_mesh_is_exact(tmp_path):
    """The bunny of models/, whose URDF was summed by its own program from the same mesh."""
    made = qr.scanned_body(BUNNY / "bunny.obj", mass=0.2)
    system = qr.System([qr.Body("bunny", BUNNY / "bunny.urdf", base="floating")])
    assert_within(made.centre, system.centres[1], 1e-9)
    assert_within(made.inertia, system.inertias[1], 1e-11)


def test_the_papers_cloud_of_992_points_is_nearly_the_hull_of_its_mesh():
    hull = trimesh.load_mesh(BUNNY / "bunny.obj").convex_hull
    assert off(qr.scanned_body(BUNNY / "bunny_992.csv", mass=MASS), hull) < WITH_NOISE


HEAD = "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
HEAD += "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n"


@pytest.mark.parametrize(
    ("name", "begin", "line"),
    [
        ("a.xyz", "", "{} {} {}\n"),
        ("a.ply", HEAD.format(302, 0), "{} {} {}\n"),
        ("a.off", "OFF\n302 0 0\n", "{} {} {}\n"),
        ("a.obj", "", "v {} {} {}\n"),
        ("a.csv", "x,y,z\n", "{},{},{}\n"),
    ],
)
def test_points_that_a_camera_did_not_see_are_left_out_of_every_kind(tmp_path, name, begin, line):
    points = on_surface(SOLIDS["box"], 300, seed=9)
    holed = np.insert(points, [5, 77], np.nan, axis=0)
    (tmp_path / name).write_text(begin + "".join(line.format(*row) for row in holed.tolist()))
    made = qr.scanned_body(tmp_path / name, mass=MASS, name="thing")
    assert_within(made.inertia, body(tmp_path, points).inertia, 1e-15)
    assert_within(np.sort(made.points, axis=0), np.sort(points, axis=0), 1e-15)
    unseen = [note for note in made.notes if "not seen" in note]
    assert unseen == ["2 points that are not numbers are left out, as what was not seen"]


@pytest.mark.parametrize("kind", ["obj", "ply"])
def test_a_vertex_that_is_nan_is_left_out_where_no_face_uses_it(tmp_path, kind):
    """A cube of 0.1 m, which holds a litre; its first vertex is NaN, and then a corner, too."""
    points = "".join("{} {} {}\n".format(*row) for row in CUBE.vertices.tolist())
    faces = (CUBE.faces + 1).tolist()
    text = HEAD.format(9, 12) + f"nan nan nan\n{points}"
    text += "".join(f"3 {a} {b} {c}\n" for a, b, c in faces)
    if kind == "obj":
        vertices = [f"v {row}" for row in ("nan nan nan", *points.splitlines())]
        rows = [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
        text = "\n".join([*vertices, *rows])
    path = tmp_path / f"cube.{kind}"
    path.write_text(text)
    made = qr.scanned_body(path, density=1000.0)
    assert made.mass == pytest.approx(1.0, rel=1e-6)
    assert "1 points that are not numbers are left out, as what was not seen" in made.notes
    corner = points.splitlines()[2]
    path.write_text(text.replace(corner, "0 NaN 0", 1))
    with pytest.raises(
        InputError, match=r"cube\....: vertices\[3\]: must be finite numbers, or NaN"
    ):
        qr.scanned_body(path, density=1000.0)


def test_a_file_of_another_kind_is_told_all_kinds_that_are_read(tmp_path):
    (tmp_path / "a.step").touch()
    with pytest.raises(InputError) as refused:
        qr.scanned_body(tmp_path / "a.step", mass=MASS)
    for kind in (*CLOUDS, *MESHES):
        assert kind in str(refused.value)


def test_a_face_alone_and_few_points_are_refused(tmp_path, rng):
    flat = np.concatenate([rng.uniform(0, 0.1, (500, 2)), np.zeros((500, 1))], axis=1)
    with pytest.raises(InputError, match="points: its points lie in a plane; give a closed mesh"):
        body(tmp_path, flat)
    with pytest.raises(InputError, match="points: must be at least 50"):
        body(tmp_path, flat[:20])
    with pytest.raises(InputError, match="say one of them"):
        body(tmp_path, flat, mass=None)


def test_thinned_points_keep_the_corners_and_cover_the_rest():
    """The corners of a cube stay, and no point is farther from those kept than these are apart.

    Else it would have been taken in place of one of them.
    """
    points = np.concatenate([on_surface(CUBE, 4000, seed=6), CUBE.vertices])
    kept = thinned(points, 100)
    assert len(kept) == 100 == len(set(kept.tolist()))
    assert set(range(4000, 4008)) <= set(kept.tolist())
    own = points[kept]
    apart = np.linalg.norm(own[:, None] - own[None], axis=2) + np.eye(100)
    away = np.linalg.norm(points[:, None] - own[None], axis=2).min(axis=1).max()
    assert away <= apart.min() + 1e-12


def run_at_rest(folder, text, within):
    """The run of a scene in which a body stays where it is, but for a distance [m]."""
    (folder / "scene.toml").write_text(text)
    run = qr.load_scenario(folder / "scene.toml", fast=True).run()
    assert not [one for one in run.findings if one.grave]
    assert abs(run["q"][-1] - run["q"][0]).max() < within
    return run


def test_the_command_writes_a_scene_that_runs(tmp_path, cli):
    """A can that stands where it was scanned stays there, and bears its weight."""
    np.save(tmp_path / "my can.npy", on_surface(SOLIDS["can"], 3000, seed=7))
    said = cli("body", tmp_path / "my can.npy", "--mass 0.35 --out", tmp_path)
    assert "my_can: the solid of a cloud is its convex hull; if the body is hollow" in said.err
    run = run_at_rest(tmp_path, said.out, 1e-3)
    assert set(run["certificate"].tolist()) == {"exact"}
    assert_relative(run["wrench"][-1, :, 2].sum(), 0.35 * 9.81, 1e-6)
    with pytest.raises(SystemExit):
        cli("body", tmp_path / "scene.toml")  # neither mass nor density
    cli("body", tmp_path / "none.csv", "--mass 1", status=2)


def test_a_box_stands_on_the_face_below(tmp_path, cli):
    """Its corners come first, so the lowest points of a face are its corners."""
    path = tmp_path / "box.stl"
    trimesh.creation.box((0.04, 0.2, 0.1)).export(path)  # it stands on 0.04 x 0.2 m
    made = qr.scanned_body(path, density=1000.0)
    assert made.height == pytest.approx(0.05)
    text = cli("body", path, "--density 1000 --points 60 --name brick --out", tmp_path).out
    run_at_rest(tmp_path, text, 1e-6)
    assert "brick" in qr.load_scenario(tmp_path / "scene.toml").bodies
    assert point_cloud(tmp_path / "brick.csv").points.shape == (60, 3)


def test_a_mesh_is_weighed_where_and_as_large_as_its_file_places_it(tmp_path):
    placed = np.diag([2.0, 2.0, 2.0, 1.0])
    placed[:3, 3] = [0.5, 0.0, 0.1]
    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box((0.04, 0.2, 0.1)), transform=placed)
    (tmp_path / "box.glb").write_bytes(scene.export(file_type="glb"))
    made = qr.scanned_body(tmp_path / "box.glb", density=1000.0)
    assert made.mass == pytest.approx(8 * 0.8, rel=1e-6)
    assert_within(made.centre, np.array([0.5, 0.0, 0.1]), 1e-7)


def test_a_cloud_on_a_coarse_grid_is_told_so(tmp_path):
    points = on_surface(CUBE, 4000, seed=8)
    assert not [note for note in body(tmp_path, points).notes if "grid" in note]
    made = body(tmp_path, np.unique(points.round(2), axis=0))
    assert [note for note in made.notes if "on a grid of 10 mm" in note]


def test_of_very_many_points_a_sample_is_covered_evenly_and_corners_stay_first(rng):
    ball = rng.normal(size=(60_000, 3))
    ball *= 0.1 / np.linalg.norm(ball, axis=1, keepdims=True)
    cube = 0.2 * np.array(list(product((-1.0, 1.0), repeat=3)))
    kept = thinned(np.concatenate([ball, cube]), 500)
    assert len(np.unique(kept)) == 500
    assert {*kept[:8].tolist()} == {*range(60_000, 60_008)}
    away, _ = cKDTree(ball[kept[8:]]).query(ball)
    assert away.max() < 0.02  # 492 discs of that radius cover the ball's surface 4.9 times
