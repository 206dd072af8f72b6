"""A trajectory as a film: an animated GIF, or MP4 where ffmpeg is there."""

import shutil
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from matplotlib import pyplot as plt
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter

from quasistatic_ref.errors import InputError, check_kind
from quasistatic_ref.files.scenario.scenario import Scenario
from quasistatic_ref.numbers.arrays import positive_number
from quasistatic_ref.optional.show.figures.camera import Camera
from quasistatic_ref.optional.show.figures.draw import camera_of, draw_scene, in_common
from quasistatic_ref.optional.show.figures.looks import CAMERA
from quasistatic_ref.optional.show.figures.moments import frames
from quasistatic_ref.optional.show.figures.style import closed, figure_style, sized
from quasistatic_ref.simulate.progress import progress_bar
from quasistatic_ref.simulate.record.trajectory import Trajectory
from quasistatic_ref.text.content import bytes_written

FRAMES_PER_SECOND = 20
DOTS_PER_INCH = 110
WRITERS: dict[str, Callable[..., AbstractMovieWriter]] = {
    ".gif": PillowWriter,
    ".mp4": FFMpegWriter,
}


def animate(
    scenario: Scenario,
    run: Trajectory,
    path: str | Path,
    *,
    view: str | Camera = CAMERA,
    fps: float = FRAMES_PER_SECOND,
    speed: float = 1.0,
    progress: bool = True,
    **options: Any,
) -> Path:
    """Write a film of a run, in real time or slower or faster, with the scale of its forces.

    Parameters
    ----------
    scenario : Scenario
        Whose bodies and shapes these are.
    run : Trajectory
    path : str or Path
        Ending in .gif or .mp4; without an ending, MP4 where ffmpeg is there and GIF elsewhere.
    view : str or Camera
    fps : float
        Frames in a second of the film [1/s]; no more than there are steps.
    speed : float
        Seconds of the run in a second of the film [-]: 0.25 is slow motion.
    progress : bool
        Whether to show a progress bar on standard error, where that is a terminal.
    options
        Further arguments of :func:`~quasistatic_ref.optional.show.figures.draw.draw_scene`.

    Returns
    -------
    Path
        The file, written whole or not at all.

    Raises
    ------
    InputError
        If the ending is another one, the run has no steps, the speed is not positive, or ffmpeg is
        not there for MP4.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> scenario = qr.load_scenario("sphere_spin", steps=2)
    >>> run = scenario.run(progress=False)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     qr.animate(scenario, run, Path(folder) / "spin.gif", progress=False).name
    'spin.gif'
    """
    check_kind(path, str | PathLike, "path", "a path")
    path = _with_ending(Path(path))
    speed = positive_number(speed, "speed")
    fps = positive_number(fps, "fps")
    camera_of(view)
    moments, shown = frames(scenario, run, fps / speed)
    fixed = in_common(moments, view) | options
    writer = WRITERS[path.suffix](fps=speed * shown)
    pace = "" if speed == 1 else f", speed {speed:g}"
    with figure_style(), plt.rc_context({"savefig.bbox": None}), TemporaryDirectory() as folder:
        figure, axes = plt.subplots(figsize=sized(4.0, 4.4), layout="constrained")
        with closed(figure):
            draw_scene(axes, moments[0], **fixed)  # before there is a film: a wrong option says so
            title = figure.suptitle(" ")
            figure.canvas.draw()
            figure.set_layout_engine("none")  # one layout, the first frame's, serves all
            film = Path(folder) / path.name
            with writer.saving(figure, str(film), DOTS_PER_INCH):
                for m in progress_bar(moments, unit="frame", words=path.name, shown=progress):
                    for drawn in (*axes.collections, *axes.patches, *axes.lines, *axes.texts):
                        drawn.remove()
                    draw_scene(axes, m, **fixed | {"legend": False})  # that of the first stays
                    title.set_text(f"t = {m.t:.2f} s{pace}")
                    writer.grab_frame()
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
