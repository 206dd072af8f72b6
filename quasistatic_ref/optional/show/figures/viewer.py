"""A scene or a run as one HTML file in 3-D that needs no network, by meshcat's viewer.

meshcat is needed for one file of JavaScript only, its viewer; the commands for that file are made
here, as plain JSON: objects and their places (:func:`scene_commands`), then an animation of them.
"""

from collections.abc import Iterator, Sequence
from html import escape
from importlib.util import find_spec
from pathlib import Path
from string import Template
from typing import Any, Final

import numpy as np
from matplotlib.colors import to_rgb

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_text, text_written
from quasistatic_ref.optional.show.figures.draw import force_scale
from quasistatic_ref.optional.show.figures.looks import (
    CAMERA,
    FIXED,
    FLOOR,
    OPACITY,
    STATES,
    body_colours,
    by_depth,
)
from quasistatic_ref.optional.show.figures.moments import (
    DrawnContact,
    Moment,
    focus,
    frames,
    middle,
    still,
)
from quasistatic_ref.optional.show.figures.surfaces import patch, surface_points, triangles
from quasistatic_ref.optional.show.figures.three import (
    clip,
    colour_clip,
    material,
    object_set,
    thing,
    z_along,
)
from quasistatic_ref.optional.show.figures.visuals import (
    AROUND,
    UP,
    Visual,
    visuals,
)
from quasistatic_ref.scenario.scenario import Scenario
from quasistatic_ref.shapes.placed_shape import Cone, HalfSpace, PlacedShape, PointCloud, Sphere
from quasistatic_ref.simulate.scene import HasScene
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.data import Array

FRAMES_PER_SECOND = 30
LONGEST = 0.25
"""Length of the largest force over the size of what is looked at [-]."""

THICK, DOT = 0.02, 0.012
"""Radii of a force, drawn as a slim cone, and of a contact over half that size [-]."""
SMALL = 12, 7
"""Corners of these around their axis and along it."""

NOTHING = 1e-9
"""Length of a force that is zero [m]: an object that is scaled by zero has no inside."""

POINT = 0.07
"""Size of a cloud's point over half that size [-]."""

REPETITIONS = 1000
SURROUNDINGS: Final = (
    ("/Grid", "visible", False),
    ("/Axes", "visible", False),
    ("/Background", "top_color", [1.0, 1.0, 1.0]),
    ("/Background", "bottom_color", [0.85, 0.9, 0.95]),
)
"""Properties of meshcat's scene: path, name and value."""
EYE: Final = 5.0 * CAMERA.axes()[2]
"""The eye from the middle of what is looked at, over half its size [-]."""
ANGLE: Final = 40
"""Of what the eye sees from top to bottom [deg]: so far away, little is distorted."""
PAGE: Final = Path(__file__).parent / "viewer.html"


def view_written(
    shown: HasScene | Trajectory, path: str | Path, run: Trajectory | None = None
) -> Path:
    """Write a scene, or a run of it, as one HTML file for a browser, without network.

    Bodies look as the visual elements of their URDFs say, or else as their collision shapes in one
    colour for each body. Contact forces are slim cones from beta along the force on beta's body,
    all on one scale; contacts are black where they stick, orange where they slide and grey where
    they bear no load.

    Parameters
    ----------
    shown : Scenario, Simulator or Trajectory
        A trajectory knows its scene where it was run in this process.
    path : str or Path
    run : Trajectory, optional
        That of the scenario or simulator; without one, the scene as it starts.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the extra ``view`` is not installed, the run has no steps, or its scene is not known.
    """
    if not isinstance(path, str | Path):
        problem = "must be a file; give what is shown, then the file, then the run"
        raise InputError(problem, field="path", value=type(path).__name__)
    viewer = viewer_script()
    scene, run = _scene(shown, run)
    moments, fps = ([still(scene)], 1.0) if run is None else frames(scene, run, FRAMES_PER_SECOND)
    looks = visuals(scene)
    centre, half = middle(focus(moments, looks))
    scale = force_scale(moments, None, half, LONGEST)
    commands = scene_commands(scene, moments, fps, half, scale, looks)
    title = scene.path.stem if isinstance(scene, Scenario) else "scene"
    page = Template(PAGE.read_text("utf-8")).substitute(
        title=escape(title), caption=_caption(title, scene, run, scale), viewer=viewer,
        commands=json_text(commands).replace("</", "<\\/"),
        eye=_y_up(centre + half * EYE), angle=ANGLE, centre=_y_up(centre),
    )  # fmt: skip
    return text_written(path, page)


def _scene(
    shown: HasScene | Trajectory, run: Trajectory | None
) -> tuple[HasScene, Trajectory | None]:
    if not isinstance(shown, Trajectory):
        return shown, run
    if shown.scene is None:
        problem = "is from a file; give its scenario or simulator first, and the trajectory as run"
        raise InputError(problem, field="trajectory")
    return shown.scene, shown


def _caption(title: str, scene: HasScene, run: Trajectory | None, scale: float) -> str:
    """What is shown, in HTML: the bodies and the states of contacts in their colours."""
    words = [escape(title)]
    if run is not None:
        words.append(f"h = {1e3 * run.header['h']:g} ms, friction {escape(run.header['cone'])}")
    words += [_coloured(name, colour) for name, colour in body_colours(scene.system).items()]
    if scale:
        words.append(f"1 N is {1e3 * scale:.3g} mm")
        words += [_coloured(state, colour) for state, colour in STATES.items()]
    return "; ".join(words)


def _coloured(word: str, colour: str) -> str:
    return f'<b style="color: {colour}">&#9632;</b> {escape(word)}'


def viewer_script() -> str:
    """Meshcat's viewer as JavaScript; InputError where the extra ``view`` is not installed."""
    found = find_spec("meshcat")
    if found is None or found.origin is None:
        problem = "needs meshcat: pip install 'quasistatic-ref[view]'"
        raise InputError(problem, field="--view")
    return (Path(found.origin).parent / "viewer" / "dist" / "main.min.js").read_text("utf-8")


def scene_commands(
    scene: HasScene,
    moments: list[Moment],
    fps: float,
    half: float,
    scale: float,
    looks: Sequence[Visual] = (),
) -> list[dict[str, Any]]:
    """Commands for the viewer: every object once, where it is at first, and how all move.

    Parameters
    ----------
    scene : Scenario or Simulator
    moments : list of Moment
        One a frame.
    fps : float
        Frames a second [1/s].
    half : float
        Half the size of what is looked at [m].
    scale : float
        [m/N].
    looks : sequence of Visual

    Returns
    -------
    list of dict
        meshcat's commands; links are at ``/links/K``, contacts at ``/contacts/J`` and their forces
        at ``/forces/J``.
    """
    contacts = range(len(moments[0].contacts))
    commands: list[dict[str, Any]] = [
        {"type": "set_property", "path": path, "property": name, "value": value}
        for path, name, value in SURROUNDINGS
    ]
    commands += _links(scene, moments[0], half, looks)
    for j in contacts:
        commands.append(object_set(f"/contacts/{j}", _over(Sphere(DOT * half), 0.0)))
        commands.append(object_set(f"/forces/{j}", _over(Cone(THICK * half, 0.5), 0.5)))
    links = {shape.link for shape in moments[0].shapes} | {visual.link for visual in looks}
    t = np.array([m.t_links for m in moments])
    R = np.array([m.R for m in moments])
    clips = [clip(f"/links/{link}", fps, t[:, link], R[:, link]) for link in sorted(links - {0})]
    for j in contacts:
        clips += _contact_clips(j, [m.contacts[j] for m in moments], fps, scale)
    options = {"play": True, "repetitions": REPETITIONS}
    play = {"type": "set_animation", "path": "", "animations": clips, "options": options}
    return [*commands, play]


def _contact_clips(
    j: int, contacts: Sequence[DrawnContact], fps: float, scale: float
) -> Iterator[dict[str, Any]]:
    """How a contact and its force move, and take the colours of its states."""
    beta = np.array([c.beta for c in contacts])
    force = scale * np.array([c.force for c in contacts])
    length = np.maximum(np.linalg.norm(force, axis=1), NOTHING)
    stretch = np.stack([np.ones_like(length), np.ones_like(length), length], axis=1)
    colour = np.array([to_rgb(STATES[c.state]) for c in contacts])
    upright = np.tile(np.eye(3), (len(beta), 1, 1))
    yield clip(f"/contacts/{j}", fps, beta, upright)
    yield clip(f"/forces/{j}", fps, beta, z_along(force), stretch)
    yield colour_clip(f"/contacts/{j}", fps, colour)
    yield colour_clip(f"/forces/{j}", fps, colour)


def _links(
    scene: HasScene, first: Moment, half: float, looks: Sequence[Visual]
) -> Iterator[dict[str, Any]]:
    """Objects of all links: what their URDFs show, or else what touches."""
    shown = {visual.link for visual in looks}
    for k, visual in enumerate(looks):
        yield object_set(f"/links/{visual.link}/visual{k}", _lit(visual.corners, visual.colour))
    for k, placed in enumerate(first.shapes):
        cloud = isinstance(placed.shape, PointCloud)
        if placed.link in shown and not cloud:
            continue
        yield object_set(f"/links/{placed.link}/{k}", _shape(placed, first, half))


def _shape(placed: PlacedShape, of: Moment, half: float) -> dict[str, Any]:
    """A shape in the frame of its link; the points of a cloud are paler by depth."""
    shape = placed.shape
    colour = of.colours[placed.link]
    if isinstance(shape, HalfSpace):
        corners = patch(shape, focus([of]).mean(axis=0), 2 * half)[[0, 1, 2, 0, 2, 3]]
        return _lit(corners, FLOOR)
    own = surface_points(shape, AROUND, UP)
    points = own @ placed.R.T + placed.t
    if isinstance(shape, PointCloud):
        look = {"type": "PointsMaterial", "size": POINT * half, "vertexColors": True}
        return thing(points, "Points", look, by_depth(colour, of.world(placed, own) @ EYE))
    return _lit(triangles(points), colour)


def _lit(corners: Array, colour: str) -> dict[str, Any]:
    """A surface that is lit."""
    return thing(corners, "Mesh", material(_number(colour), OPACITY.get(colour, 1.0)))


def _over(shape: Sphere | Cone, z: float) -> dict[str, Any]:
    """A small shape that nothing hides, its centre at a height z [m]."""
    corners = triangles(surface_points(shape, *SMALL) + np.array([0.0, 0.0, z]))
    look = {"type": "MeshBasicMaterial", "depthTest": False, "transparent": True}
    found = thing(corners, "Mesh", look | {"color": _number(FIXED)})
    found["object"]["renderOrder"] = 1
    return found


def _number(colour: str) -> int:
    """A colour as three.js has it, a byte each."""
    return int(colour.removeprefix("#"), 16)


def _y_up(point: Array) -> str:
    """Coordinates in the frame of meshcat's camera, whose y is the world's z."""
    x, y, z = point
    return f"{x:.6g}, {z:.6g}, {-y:.6g}"
