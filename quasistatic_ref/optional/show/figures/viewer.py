"""A scene or a run as one HTML file in 3-D that needs no network, by meshcat.

meshcat's own server keeps what is drawn, and writes the file; it runs while the file is made.
"""

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from html import escape
from importlib import import_module
from io import StringIO
from pathlib import Path
from types import ModuleType
from typing import Any, Final

import numpy as np

from quasistatic_ref.contact.jacobian import tangents
from quasistatic_ref.errors import InputError, check_kind
from quasistatic_ref.files.scenario.scenario import Scenario
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures.draw import force_scale
from quasistatic_ref.optional.show.figures.looks import (
    CAMERA,
    FLOOR,
    OPACITY,
    STATES,
    body_colours,
    by_depth,
)
from quasistatic_ref.optional.show.figures.moments import Moment, focus, frames, middle, still
from quasistatic_ref.optional.show.figures.surfaces import patch, surface_points, triangles
from quasistatic_ref.optional.show.figures.visuals import AROUND, UP, Visual, visuals
from quasistatic_ref.parts import needed_package
from quasistatic_ref.shapes.placed_shape import HalfSpace, PlacedShape, PointCloud
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.simulate.scene import Scene
from quasistatic_ref.text.content import text_written

FRAMES_PER_SECOND = 30
LONGEST = 0.25
"""Length of the largest force over the size of what is looked at [-]."""

THICK, DOT = 0.02, 0.012
"""Radii of a force, drawn as a slim cone, and of a contact over half that size [-]."""

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
CAPTION: Final = (
    '<div style="position: fixed; left: 1em; bottom: 1em; font-family: sans-serif; '
    'background: rgba(255, 255, 255, 0.8)">{}</div>'
)


def save_view(path: str | Path, shown: Scene | Trajectory, run: Trajectory | None = None) -> Path:
    """Write a scene, or a run of it, as one HTML file for a browser, without network.

    Bodies look as the visual elements of their URDFs say, or else as their collision shapes in one
    colour for each body. Contact forces are slim cones from beta along the force on beta's body,
    all on one scale; contacts are black where they stick, orange where they slide and grey where
    they bear no load.

    Parameters
    ----------
    path : str or Path
    shown : Scenario, Simulator or Trajectory
        A trajectory knows its scene where it was run in this process.
    run : Trajectory, optional
        That of the scenario or simulator; without one, the scene as it starts.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the extra ``view`` is not installed, the run has no steps, or its scene is not known.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     qr.save_view(Path(folder) / "spin.html", qr.load_scenario("sphere_spin")).name
    'spin.html'
    """
    meshcat = viewer_package()
    scene, run = _scene(shown, run)
    moments, fps = ([still(scene)], 1.0) if run is None else frames(scene, run, FRAMES_PER_SECOND)
    looks = visuals(scene)
    centre, half = middle(focus(moments, looks))
    scale = force_scale(moments, None, half, LONGEST)
    with _visualizer(meshcat) as visualizer:
        scene_drawn(visualizer, moments, fps, centre, half, scale, looks)
        page = visualizer.static_html()
    title = scene.path.stem if isinstance(scene, Scenario) else "scene"
    before, end, after = page.rpartition("</body>")
    before = before.replace("<title>MeshCat</title>", f"<title>{escape(title)}</title>", 1)
    caption = CAPTION.format(_caption(title, scene, run, scale, moments[0].newton))
    return text_written(path, f"{before}{caption}{end}{after}")


def viewer_package() -> ModuleType:
    """meshcat; InputError where the extra ``view`` is not installed."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of how it imports pyzmq
        return needed_package("meshcat", "view", "--view")


@contextmanager
def _visualizer(meshcat: ModuleType) -> Iterator[Any]:
    """A context with a meshcat visualizer, which prints no address and ends with it."""
    with redirect_stdout(StringIO()):
        visualizer = meshcat.Visualizer()
    try:
        yield visualizer
    finally:
        window = visualizer.window
        window.zmq_socket.close(linger=0)
        window.server_proc.kill()
        window.server_proc.communicate()


def _scene(shown: Scene | Trajectory, run: Trajectory | None) -> tuple[Scene, Trajectory | None]:
    if not isinstance(shown, Trajectory):
        check_kind(shown, Scene, "shown", "a Scenario, a Simulator or a Trajectory")
        return shown, run
    if shown.scene is None:
        problem = "is from a file; give its scenario or simulator first, and the trajectory as run"
        raise InputError(problem, field="trajectory")
    return shown.scene, shown


def _caption(title: str, scene: Scene, run: Trajectory | None, scale: float, newton: str) -> str:
    """The HTML text below a view: its title, and the colours of bodies and contact states."""
    words = [escape(title)]
    if run is not None:
        words.append(f"h = {1e3 * run.header.h:g} ms, friction {escape(run.header.cone)}")
    words += [_coloured(name, colour) for name, colour in body_colours(scene.system).items()]
    if scale:
        words.append(f"{newton} is {1e3 * scale:.3g} mm")
        words += [_coloured(state, colour) for state, colour in STATES.items()]
    return "; ".join(words)


def _coloured(word: str, colour: str) -> str:
    return f'<b style="color: {colour}">&#9632;</b> {escape(word)}'


def scene_drawn(
    visualizer: Any,
    moments: Sequence[Moment],
    fps: float,
    centre: Array,
    half: float,
    scale: float,
    looks: Sequence[Visual] = (),
) -> None:
    """Draw every object of a scene once, and add how all of them move.

    Links are at ``links/K``, contacts at ``contacts/J`` and their forces at ``forces/J``, each of
    these with an object for each state, of which one is visible at a time.

    Parameters
    ----------
    visualizer : meshcat.Visualizer
    moments : sequence of Moment
        One a frame.
    fps : float
        Frames a second [1/s].
    centre : ndarray, shape (3,)
        The middle of what is looked at [m].
    half : float
        Half its size [m].
    scale : float
        [m/N].
    looks : sequence of Visual
    """
    for path, name, value in SURROUNDINGS:
        visualizer[path].set_property(name, value)
    camera = visualizer["/Cameras/default/rotated/<object>"]
    x, y, z = half * EYE
    camera.set_property("position", [x, z, -y])  # in a frame whose y is the world's z
    camera.set_property("fov", ANGLE)
    visualizer.set_transform(_place(-centre))  # the camera looks at the origin
    _draw_links(visualizer["links"], moments[0], half, looks)
    geometry = import_module("meshcat.geometry")
    for j, _ in enumerate(moments[0].contacts):
        for state, colour in STATES.items():
            look = geometry.MeshBasicMaterial(_number(colour), transparent=True, depthTest=False)
            dot = visualizer[f"contacts/{j}/{state}"]
            dot.set_object(geometry.Sphere(DOT * half), look)
            force = visualizer[f"forces/{j}/{state}"]
            force.set_object(geometry.Cylinder(1.0, radiusBottom=THICK * half, radiusTop=0.0), look)
            force.set_transform(_place(np.array([0.0, 0.5, 0.0])))
    links = {shape.link for shape in moments[0].shapes} | {visual.link for visual in looks}
    animation = import_module("meshcat.animation").Animation(default_framerate=fps)
    start = animation.at_frame(visualizer, 0)
    for j, _ in enumerate(moments[0].contacts):
        for path in (f"{kind}/{j}/{state}" for kind in ("contacts", "forces") for state in STATES):
            # After what could hide it. meshcat writes the names of properties in lower case, but
            # not of those that are animated.
            start[path].set_property("renderOrder", "number", 1)
    for k, moment in enumerate(moments):
        frame = animation.at_frame(visualizer, k)
        for link in sorted(links - {0}):
            frame[f"links/{link}"].set_transform(_place(moment.t_links[link], moment.R[link]))
        for j, contact in enumerate(moment.contacts):
            force = scale * contact.force
            length = max(float(np.linalg.norm(force)), NOTHING)
            frame[f"contacts/{j}"].set_transform(_place(contact.beta))
            frame[f"forces/{j}"].set_transform(_place(contact.beta, _y_along(force)))
            frame[f"forces/{j}"].set_property("scale", "vector3", [1.0, length, 1.0])
            for state in STATES:
                for path in ("contacts", "forces"):
                    visible = state == contact.state
                    frame[f"{path}/{j}/{state}"].set_property("visible", "boolean", visible)
    visualizer.set_animation(animation, play=True, repetitions=REPETITIONS)


def _draw_links(links: Any, first: Moment, half: float, looks: Sequence[Visual]) -> None:
    """Draw all links with their URDF's visuals, or else their shapes, and the clouds."""
    for k, visual in enumerate(looks):
        links[f"{visual.link}/visual{k}"].set_object(*_lit(visual.corners, visual.colour))
    visible = {visual.link for visual in looks}
    for k, placed in enumerate(first.shapes):
        if isinstance(placed.shape, PointCloud):
            links[f"{placed.link}/{k}"].set_object(_cloud(placed, placed.shape, first, half))
        elif placed.link not in visible:
            links[f"{placed.link}/{k}"].set_object(*_solid(placed, first, half))


def _solid(placed: PlacedShape, of: Moment, half: float) -> tuple[Any, Any]:
    """The surface of a solid, or a patch of a half-space, in the frame of its link."""
    shape = placed.shape
    if isinstance(shape, HalfSpace):
        corners = patch(shape, focus([of]).mean(axis=0), 2 * half)[[0, 1, 2, 0, 2, 3]]
        return _lit(corners, FLOOR)
    points = surface_points(shape, AROUND, UP) @ placed.R.T + placed.t
    return _lit(triangles(points), of.colours[placed.link])


def _cloud(placed: PlacedShape, cloud: PointCloud, of: Moment, half: float) -> Any:
    """The points of a cloud in the frame of its link; the paler the deeper."""
    geometry = import_module("meshcat.geometry")
    points = cloud.points @ placed.R.T + placed.t
    colours = by_depth(of.colours[placed.link], of.world(placed, cloud.points) @ EYE)
    return geometry.PointCloud(points.T, colours.T, size=POINT * half)


def _lit(corners: Array, colour: str) -> tuple[Any, Any]:
    """A surface that is lit, of triangles (3T, 3) [m]: geometry and material."""
    geometry = import_module("meshcat.geometry")
    faces = np.arange(len(corners)).reshape(-1, 3)
    material = geometry.MeshPhongMaterial(_number(colour), opacity=OPACITY.get(colour, 1.0))
    return geometry.TriangularMeshGeometry(corners, faces), material


def _place(t: Array, R: Array | None = None) -> Array:
    """A pose as a matrix, shape (4, 4)."""
    matrix = np.eye(4)
    matrix[:3, 3] = t
    if R is not None:
        matrix[:3, :3] = R
    return matrix


def _y_along(direction: Array) -> Array:
    """A rotation (3, 3) that takes y, the axis of meshcat's cylinders, to a direction (3,)."""
    length = np.linalg.norm(direction)
    y = direction / length if length > 0 else np.array([0.0, 0.0, 1.0])
    d1, d2 = (axis[0] for axis in tangents(y[None]))  # with d1 x d2 = y
    return np.column_stack([d2, y, d1])


def _number(colour: str) -> int:
    """A colour as the 24-bit integer that three.js takes."""
    return int(colour.removeprefix("#"), 16)
