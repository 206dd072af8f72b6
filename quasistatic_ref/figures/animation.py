"""A trajectory as a film: an animated GIF, or MP4 where ffmpeg is there."""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter

from quasistatic_ref.errors import InputError
from quasistatic_ref.figures.camera import Camera
from quasistatic_ref.figures.draw import draw_scene
from quasistatic_ref.figures.moments import extent, frames
from quasistatic_ref.figures.style import figure_style, sized
from quasistatic_ref.files import bytes_written
from quasistatic_ref.simulate.scenario import Scenario
from quasistatic_ref.simulate.trajectory import Trajectory

VIEW = Camera(azimuth=-62, elevation=12)
FRAMES_PER_SECOND = 20
DOTS_PER_INCH = 110
WRITERS: dict[str, type[AbstractMovieWriter]] = {".gif": PillowWriter, ".mp4": FFMpegWriter}


def animate(
    scenario: Scenario,
    run: Trajectory,
    path: str | Path,
    *,
    view: str | Camera = VIEW,
    fps: int = FRAMES_PER_SECOND,
    **options: Any,
) -> Path:
    """Write a film of a run, in real time.

    Parameters
    ----------
    scenario : Scenario
        Whose bodies and shapes these are.
    run : Trajectory
    path : str or Path
        Ending in .gif or .mp4; without an ending, MP4 where ffmpeg is there and GIF elsewhere.
    view : str or Camera
    fps : int
        Frames per second, at least 1; no more than there are steps.
    options
        Further arguments of :func:`~quasistatic_ref.figures.draw.draw_scene`.

    Returns
    -------
    Path
        The file, written whole or not at all.

    Raises
    ------
    InputError
        If the ending is another one, the run has no steps, or ffmpeg is not there for MP4.
    """
    path = _with_ending(Path(path))
    moments, fps_shown = frames(scenario, run, fps)
    boxes = np.array([extent(m) for m in moments])
    centre = (boxes[:, 0].min(axis=0) + boxes[:, 1].max(axis=0)) / 2
    half = float((boxes[:, 1].max(axis=0) - boxes[:, 0].min(axis=0)).max()) / 2
    most = max((float(np.linalg.norm(c.force)) for m in moments for c in m.contacts), default=0.0)
    fixed: dict[str, Any] = {
        "view": view, "around": (centre, half), "legend": False, "parts": ("contacts", "forces"),
        "metres_per_newton": 0.5 * half / most if most > 0 else 0.0,
    } | options  # fmt: skip
    writer: Any = WRITERS[path.suffix](fps=fps_shown)  # type: ignore[arg-type]  # of any number
    with figure_style(), plt.rc_context({"savefig.bbox": None}), TemporaryDirectory() as folder:
        figure, axes = plt.subplots(figsize=sized(4.0, 4.0))
        film = Path(folder) / path.name
        with writer.saving(figure, str(film), DOTS_PER_INCH):
            for m in moments:
                axes.clear()
                draw_scene(axes, m, **fixed)
                axes.set_title(f"t = {m.t:.2f} s")
                writer.grab_frame()
        plt.close(figure)
        return bytes_written(path, film.read_bytes())


def _with_ending(path: Path) -> Path:
    ffmpeg = shutil.which("ffmpeg") is not None
    if not path.suffix:
        path = path.with_name(path.name + (".mp4" if ffmpeg else ".gif"))
    if path.suffix not in WRITERS:
        raise InputError("must end in .gif or .mp4", field="path", value=str(path))
    if path.suffix == ".mp4" and not ffmpeg:
        raise InputError("cannot be written without ffmpeg; install it, or write .gif", file=path)
    return path
