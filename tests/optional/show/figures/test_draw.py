"""Scenes are drawn to scale: bodies, contact frames, cones and forces where the numbers say."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib import pyplot as plt
from PIL import Image

from quasistatic_ref import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    InputError,
    PointCloud,
    Sphere,
    animate,
    draw_scene,
    draw_scenes,
    load_scenario,
)
from quasistatic_ref.optional.show.figures import Camera, animation, panels
from quasistatic_ref.optional.show.figures.draw import PARTS
from quasistatic_ref.optional.show.figures.moments import moment
from quasistatic_ref.optional.show.figures.style import figure_written
from quasistatic_ref.optional.show.figures.surfaces import (
    AROUND,
    UP,
    surface_points,
)
from tests.closeness import assert_close, assert_relative, assert_same, assert_within
from tests.tolerances import ROUNDING

SLOPE = np.radians(25)


@pytest.fixture(scope="module")
def incline():
    scenario = load_scenario("block_incline", ["steps=30"], fast=True)
    return scenario, scenario.run()


@pytest.fixture(scope="module")
def end(incline):
    """The moment of the last step."""
    return moment(*incline, -1)


@pytest.fixture
def page():
    figure, (axes,) = panels(4.6, 4.0)
    yield axes
    plt.close(figure)


def test_a_moment_holds_the_numbers_of_its_step(incline):
    scenario, run = incline
    of = moment(scenario, run, 12 - run.steps)
    assert_relative(of.t, 12 * scenario.h)
    assert len(of.contacts) == 8
    for j, contact in enumerate(of.contacts):
        f_1, f_2, f_n, _ = run.forces[12, j]
        d1, d2, n = (run[name][12, j] for name in ("d1", "d2", "n"))
        assert_close(contact.force, f_1 * d1 + f_2 * d2 + f_n * n)
        assert_same(contact.beta, run["beta"][12, j])
        # The rim of the pyramid: n f_n + mu_v f_n d for the four directions d.
        corners = np.array([f_n * (n + contact.mu_v * d) for d in (d1, d2, -d1, -d2)])
        apart = np.linalg.norm(contact.rim[:, None] - corners, axis=2)
        assert (apart.min(axis=0) < ROUNDING).all()
        assert len(contact.rim) == 4
    kinematics = scenario.system.kinematics(run["q"][12])
    assert_same(of.R, kinematics.R)


@pytest.mark.parametrize("k", [30, -31])
def test_a_moment_of_no_step_is_refused(incline, k):
    with pytest.raises(InputError, match="must be -30 to 29"):
        moment(*incline, k)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ({"view": "zx"}, "view: must be a Camera or one of"),
        ({"parts": ["force"]}, "parts: must be some of"),
    ],
)
def test_a_view_or_a_part_that_does_not_exist_is_named(end, page, words, says):
    with pytest.raises(InputError, match=says):
        draw_scene(page, end, **words)


@pytest.mark.parametrize(
    ("file", "words"),
    [("blocks.mp4", "cannot be written without ffmpeg"), ("blocks.png", r"must end in \.gif or")],
)
def test_films_that_cannot_be_written_are_refused(incline, tmp_path, monkeypatch, file, words):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(InputError, match=words):
        animate(*incline, tmp_path / file)


def test_forces_and_frames_are_drawn_to_scale_where_they_are(end, page):
    idle = replace(end.contacts[0], state="apart")
    of = replace(end, contacts=(idle, *end.contacts[1:]))
    draw_scene(page, of, metres_per_newton=0.02, parts=PARTS)
    arrows = [text for text in page.texts if text.arrow_patch is not None]
    loaded = [c for c in of.contacts if c.bears]
    dots = [line for line in page.lines if line.get_marker() == "o"]
    filled = [dot.get_xydata()[0] for dot in dots if dot.get_markerfacecolor() != "white"]
    assert len(arrows) == len(loaded) == len(filled) < len(dots)
    for arrow, contact, dot in zip(arrows, loaded, filled, strict=True):
        x, _, z = 1e3 * contact.beta
        u, _, w = 1e3 * 0.02 * contact.force
        assert_relative([arrow.xyann, dot], [(x, z), (x, z)])
        assert_relative(arrow.xy, (x + u, z + w))
    at = 1e3 * loaded[0].beta[[0, 2]]
    solid = [line.get_xydata() for line in page.lines if line.get_linestyle() == "-"]
    (start, end), *_ = [ends for ends in solid if np.allclose(ends[0], at)]
    unit = (end - start) / np.linalg.norm(end - start)
    assert_close(unit, [np.sin(SLOPE), np.cos(SLOPE)])


@pytest.mark.parametrize(
    ("record", "newton"), [("full", "1 N"), ("forces", "1 N"), ("light", "1 N of lam")]
)
def test_the_legend_says_where_forces_are_not_unique(page, record, newton):
    scenario = load_scenario("block_push", [f"record={record}"], steps=1, fast=True)
    draw_scene(page, moment(scenario, scenario.run(), 0), metres_per_newton=0.02)
    assert page.get_legend().get_texts()[0].get_text() == f"{newton} is 20 mm"


def test_a_camera_from_the_front_sees_y_to_the_right_and_z_upwards():
    seen = Camera(azimuth=0, elevation=0).seen(np.array([[1.0, 2.0, 3.0]]))
    assert_relative(seen, [[2, 3, 1]])


def test_panels_have_one_view_and_one_scale_of_forces(incline, end):
    figure, both = panels(6, 3, columns=2)
    draw_scenes(both, [moment(*incline, 0), end])
    first, last = (
        (a.get_xlim(), a.get_ylim(), a.get_legend().get_texts()[0].get_text()) for a in both
    )
    assert first == last
    plt.close(figure)


def test_a_body_s_outline_is_where_the_body_is(end, page):
    draw_scene(page, end, parts=())
    drawn = [p.get_xy()[:-1] for p in page.patches if not p.get_facecolor()[3]]  # not the floor
    (rough, smooth) = [s for s in end.shapes if isinstance(s.shape, Box)]
    drawn.sort(key=lambda outline: outline[:, 0].max())
    for outline, placed in zip(drawn, (rough, smooth), strict=True):
        corners = 1e3 * end.world(placed, surface_points(placed.shape))[:, [0, 2]]
        assert_relative(outline.max(axis=0), corners.max(axis=0))
        assert_relative(outline.min(axis=0), corners.min(axis=0))


def test_the_dots_of_a_cloud_are_where_its_points_are(end, page):
    cloud = PointCloud([[0.0, 0.0, 0.0], [0.04, 0.01, 0.0], [0.0, 0.02, 0.03]])
    placed = next(s for s in end.shapes if isinstance(s.shape, Box))
    draw_scene(page, replace(end, shapes=(replace(placed, shape=cloud),)), parts=())
    (dots,) = (c.get_offsets() for c in page.collections if len(c.get_offsets()) == 3)
    points = 1e3 * end.world(placed, cloud.points)[:, [0, 2]]
    assert_relative(np.sort(dots, axis=0), np.sort(points, axis=0))


def test_the_circle_of_torsion_has_radius_mu_omega(page):
    scenario = load_scenario("sphere_spin", ["h=0.05", "steps=9"], fast=True)
    run = scenario.run()
    for k, share in ((3, 0.5), (8, 1.0)):  # the torque grows to five times the limit in 40 steps
        page.clear()
        draw_scene(page, moment(scenario, run, k), view="xy", legend=False, parts=("cones",))
        (circle,) = [line for line in page.lines if len(line.get_xdata()) > 2]
        x, y = circle.get_data()
        assert_within(np.hypot(x, y), 10.0, 1e-3)  # mm; it is lifted by microns
        turned = np.ptp(np.unwrap(np.arctan2(y, x)))
        assert_relative(turned, 2 * np.pi * share, 1e-6)


@pytest.mark.parametrize(
    "shape",
    [
        Box((0.1, 0.2, 0.3)), Sphere(0.1), Capsule(0.1, 0.4), Cylinder(0.1, 0.4),
        Cone(0.1, 0.4), Ellipsoid((0.1, 0.2, 0.3)),
    ],
    ids=lambda shape: type(shape).__name__,
)  # fmt: skip
def test_points_drawn_of_a_shape_are_on_it_and_reach_as_far(shape):
    """An ellipsoid of half axes a and b, seen along a, reaches to a / (1 + (b/a)^2 tan^2 d)^1/2.

    That is at an angle d from a direction that is tried; no direction is farther from one of those
    than half of their distances around the axis and along it.
    """
    points = surface_points(shape)
    assert_within(shape.signed_distance(points)[0], 0.0)
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    whole = shape.support_value(axes)
    apart = np.tan(np.hypot(np.pi / (AROUND - 1), np.arcsin(1 / (UP - 1))))
    least = whole / np.sqrt(1 + (whole.max() / whole.min() * apart) ** 2)
    assert ((points @ axes.T).max(axis=0) >= least).all()


def test_a_film_has_as_many_frames_a_second_as_were_wanted(incline, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "")  # without ffmpeg
    path = animate(*incline, tmp_path / "blocks", fps=10)
    assert [p.name for p in tmp_path.iterdir()] == ["blocks.gif"]
    with Image.open(path) as film:
        assert film.n_frames == 3  # 30 steps of 10 ms
        assert film.info["duration"] == 100


@pytest.mark.parametrize("fails", ["draw_scene", "bytes_written"])
def test_a_film_that_fails_closes_its_figure(incline, tmp_path, monkeypatch, fails):
    monkeypatch.setenv("PATH", "")  # without ffmpeg
    before = plt.get_fignums()
    with monkeypatch.context() as broken:
        broken.setattr(animation, fails, lambda *_, **__: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            animate(*incline, tmp_path / "blocks")
    assert plt.get_fignums() == before
    assert [*tmp_path.iterdir()] == []


def test_a_figure_that_cannot_be_written_is_closed(tmp_path, monkeypatch):
    before = plt.get_fignums()
    figure = plt.figure()
    monkeypatch.setattr(figure, "savefig", lambda *_, **__: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        figure_written(figure, tmp_path, "name")
    assert plt.get_fignums() == before


@pytest.mark.parametrize(
    ("parts", "mu_v", "wider"),
    [
        (("forces", "cones"), 0.5, True),
        (("forces",), 0.5, False),
        (("forces", "cones"), 0.0, False),
    ],
)
def test_a_drawing_has_room_for_the_rim_of_a_cone_that_is_drawn(end, page, parts, mu_v, wider):
    limits = []
    for factor in (1.0, 100.0):
        rims = [replace(c, rim=factor * c.rim, mu_v=mu_v) for c in end.contacts]
        draw_scene(page, replace(end, contacts=tuple(rims)), parts=parts, metres_per_newton=0.01)
        limits.append(page.get_xlim())
    assert (limits[0] != limits[1]) == wider
