"""A trajectory as one HTML file with a 3-D scene that plays, by meshcat's viewer, without network.

meshcat is needed for one file of JavaScript only, its viewer; the commands for that file are made
here, as plain JSON: objects and their places (:func:`scene_commands`), then an animation of them.
"""

from html import escape
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any, Final

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_text, text_written
from quasistatic_ref.optional.show.figures.draw import round_scale
from quasistatic_ref.optional.show.figures.moments import Moment, extent, frames
from quasistatic_ref.optional.show.figures.surfaces import patch, surface_points, triangles
from quasistatic_ref.optional.show.figures.three import (
    clip,
    material,
    object_set,
    thing,
    transform_set,
    z_along,
)
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.shapes.placed_shape import HalfSpace, PlacedShape, PointCloud
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

FRAMES_PER_SECOND = 30
LONGEST = 0.5
"""Length of the largest force over half the scene's size [-]."""

THICK = 0.02
"""Radius of a force, drawn as a slim cone, over half the scene's size [-]."""

NOTHING = 1e-9
"""Length of a force that is zero [m]: an object that is scaled by zero has no inside."""

REPETITIONS = 1000
CLOUD, SOLID, FLOOR, FORCE = 0x0072B2, 0x9A9A9A, 0xE8E8E8, 0xD55E00
HIDDEN: Final = ("/Grid", "/Axes")
SKY: Final = {"top_color": [1.0, 1.0, 1.0], "bottom_color": [0.85, 0.9, 0.95]}
PAGE: Final = Path(__file__).parent / "viewer.html"


def view_written(scenario: Scenario, run: Trajectory, path: str | Path) -> Path:
    """Write a run as one HTML file that plays in a browser, without network.

    Contact forces are slim orange cones from beta along the force on beta's body.

    Parameters
    ----------
    scenario : Scenario
        Whose bodies and shapes these are.
    run : Trajectory
    path : str or Path

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the extra ``view`` is not installed, or the run has no steps.
    """
    viewer = viewer_script()
    moments, fps = frames(scenario, run, FRAMES_PER_SECOND)
    box = extent(moments[0])
    centre, half = box.mean(axis=0), float(np.ptp(box, axis=0).max()) / 2
    eye = centre + half * np.array([1.1, -2.2, 0.9])
    scale = metres_per_newton(moments, half)
    name = scenario.path.stem
    caption = f"{name}, h = {1e3 * scenario.h:g} ms, friction {scenario.cone}"
    if scale:
        caption += f"; forces in orange, 1 N is {1e3 * scale:.3g} mm"
    page = Template(PAGE.read_text("utf-8")).substitute(
        title=escape(name), caption=escape(caption), viewer=viewer,
        commands=json_text(scene_commands(moments, fps, half, scale)).replace("</", "<\\/"),
        eye=_y_up(eye), centre=_y_up(centre),
    )  # fmt: skip
    return text_written(path, page)


def viewer_script() -> str:
    """Meshcat's viewer as JavaScript; InputError where the extra ``view`` is not installed."""
    found = find_spec("meshcat")
    if found is None or found.origin is None:
        problem = "needs meshcat: pip install 'quasistatic-ref[view]'"
        raise InputError(problem, field="--view")
    return (Path(found.origin).parent / "viewer" / "dist" / "main.min.js").read_text("utf-8")


def metres_per_newton(moments: list[Moment], half: float) -> float:
    """Length at which a force of 1 N is shown [m/N]; 0 where there are no forces.

    Parameters
    ----------
    moments : list of Moment
    half : float
        Half the scene's size [m].
    """
    forces = [np.linalg.norm(c.force) for m in moments for c in m.contacts]
    most = float(max(forces, default=0.0))
    return round_scale(LONGEST * half / most) if most > 0 else 0.0


def scene_commands(
    moments: list[Moment], fps: float, half: float, scale: float
) -> list[dict[str, Any]]:
    """Commands for the viewer: every object once, where it is at first, and how all move.

    Parameters
    ----------
    moments : list of Moment
        One a frame.
    fps : float
        Frames a second [1/s].
    half : float
        Half the scene's size [m].
    scale : float
        [m/N].

    Returns
    -------
    list of dict
        meshcat's commands; links are at ``/links/K``, contact forces at ``/forces/J``.
    """
    first = moments[0]
    commands: list[dict[str, Any]] = [
        {"type": "set_property", "path": path, "property": "visible", "value": False}
        for path in HIDDEN
    ]
    commands += [
        {"type": "set_property", "path": "/Background", "property": name, "value": colour}
        for name, colour in SKY.items()
    ]
    for k, placed in enumerate(first.shapes):
        path = f"/links/{placed.link}/{k}"
        commands.append(object_set(path, _shape(placed, first, half)))
        if not isinstance(placed.shape, HalfSpace):
            commands.append(transform_set(path, placed.R, placed.t))
    for j in range(len(first.contacts)):
        commands.append(object_set(f"/forces/{j}", _spike(THICK * half)))
    clips = []
    for link in sorted({placed.link for placed in first.shapes} - {0}):
        t = np.array([m.t_links[link] for m in moments])
        clips.append(clip(f"/links/{link}", fps, t, np.array([m.R[link] for m in moments])))
    for j in range(len(first.contacts)):
        beta = np.array([m.contacts[j].beta for m in moments])
        force = scale * np.array([m.contacts[j].force for m in moments])
        length = np.maximum(np.linalg.norm(force, axis=1), NOTHING)
        stretch = np.stack([np.ones_like(length), np.ones_like(length), length], axis=1)
        clips.append(clip(f"/forces/{j}", fps, beta, z_along(force), stretch))
    options = {"play": True, "repetitions": REPETITIONS}
    play = {"type": "set_animation", "path": "", "animations": clips, "options": options}
    return [*commands, play]


def _shape(placed: PlacedShape, of: Moment, half: float) -> dict[str, Any]:
    shape = placed.shape
    if isinstance(shape, PointCloud):
        return thing(shape.points, "Points", {"type": "PointsMaterial", "color": CLOUD,
                                                "size": 0.02 * half})  # fmt: skip
    if isinstance(shape, HalfSpace):
        corners = patch(shape, extent(of).mean(axis=0), 2 * half)[[0, 1, 2, 0, 2, 3]]
        return thing(corners, "Mesh", material(FLOOR, 0.8))
    points = surface_points(placed, around=32, up=13)
    return thing(points[triangles(points)].reshape(-1, 3), "Mesh", material(SOLID, 0.6))


def _spike(radius: float) -> dict[str, Any]:
    """A cone of length 1 along z, its base at the origin."""
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    base = radius * np.stack([np.cos(angle), np.sin(angle), np.zeros(12)], axis=1)
    points = np.vstack([base, [0.0, 0.0, 1.0]])
    return thing(points[triangles(points)].reshape(-1, 3), "Mesh", material(FORCE, 1.0))


def _y_up(point: Array) -> str:
    """Coordinates in the frame of meshcat's camera, whose y is the world's z."""
    x, y, z = point
    return f"{x:.6g}, {z:.6g}, {-y:.6g}"
