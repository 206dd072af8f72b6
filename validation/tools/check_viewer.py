"""Play the page of ``run --view`` in a headless Chromium, and compare it with the trajectory.

Run ``python -m validation.tools.check_viewer [FOLDER]`` from a checkout (extra ``view``, and
Debian's package chromium); screenshots stay in FOLDER, if it is given. Exit status 1 at the first
thing that is wrong, a missing browser included: nothing is skipped.
"""

import io
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from PIL import Image

from quasistatic_ref import load_scenario, trajectory_read
from quasistatic_ref.cli.main import main as command
from quasistatic_ref.optional.show.figures.draw import force_scale
from quasistatic_ref.optional.show.figures.moments import Moment, focus, frames, middle
from quasistatic_ref.optional.show.figures.viewer import FRAMES_PER_SECOND, LONGEST
from quasistatic_ref.optional.show.figures.visuals import visuals
from validation.tools.browser import Browser, check

SCENES = {
    "bunny_grasp": ["steps=120"],
    "peg_in_hole": ["h=0.02", "steps=100"],
    "panda_push": ["h=0.02", "steps=30"],
}
PLACE = 1e-6
"""Of positions [m], matrices [-] and lengths of forces [m]: three.js keeps keyframes in float32."""

COLOURS = 50
"""Fewest colours of a picture of a lit scene; an empty one has those of its background."""


Z_UP = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
"""From the frame of three.js, whose y is up, to the world's."""


def matrix(browser: Browser, path: list[str]) -> np.ndarray:
    """Matrix of a node in the world whose z is up, shape (4, 4)."""
    node = f"viewer.scene_tree.find({path}).object"
    found = browser.value(f"({node}.updateWorldMatrix(true, false), {node}.matrixWorld.elements)")
    return Z_UP @ np.array(found).reshape(4, 4).T


def picture(browser: Browser, path: Path) -> np.ndarray:
    """A screenshot, shape (height, width, 3), also as a file."""
    data = browser.screenshot()
    path.write_bytes(data)
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))


def check_scene(name: str, settings: list[str], folder: Path) -> None:
    """One scenario: the page without network, its places and forces, that it plays, its picture."""
    arguments = [word for setting in settings for word in ("--set", setting)]
    status = command(["run", name, "--view", "--json", "--out", str(folder), *arguments])
    check(status != 0, f"run {name} --view ended with status {status}")
    scenario = load_scenario(name, settings)
    run = trajectory_read(folder / f"{name}.npz")
    moments, fps = frames(scenario, run, FRAMES_PER_SECOND)
    _, half = middle(focus(moments, visuals(scenario)))
    scale = force_scale(moments, None, half, LONGEST)
    with Browser() as browser:
        browser.open(folder / f"{name}.html")
        browser.until("typeof viewer !== 'undefined' && viewer.animator.duration > 0")
        duration = (len(moments) - 1) / fps
        found = browser.value("viewer.animator.duration")
        check(abs(found - duration) > 1e-4, f"it lasts {found} s, not {duration} s")
        check(not browser.value("viewer.animator.playing"), "it does not play by itself")
        browser.until("viewer.animator.time > 0")
        browser.value("viewer.animator.pause()")
        pictures = []
        for k in (0, len(moments) // 2, len(moments) - 1):
            browser.value(f"viewer.animator.seek({k / fps!r})")
            worst = worst_place(browser, moments[k], scale)
            check(worst > PLACE, f"something of frame {k} is {worst:.1e} m from its place")
            browser.value("viewer.render()")
            pictures.append(picture(browser, folder / f"{name}_{k}.png"))
        colours = [len(np.unique(p.reshape(-1, 3), axis=0)) for p in pictures]
        check(min(colours) < COLOURS, f"a picture has {min(colours)} colours only")
        check(bool((pictures[0] == pictures[-1]).all()), "nothing moves in the pictures")
        check(bool(browser.faults()), "; ".join(browser.faults()))
    print(f"{name}: {len(moments)} frames, {len(moments[0].contacts)} forces: good")


def worst_place(browser: Browser, of: Moment, scale: float) -> float:
    """Largest difference of any link's pose or contact's force from those of a moment."""
    errors = [0.0]
    for link in sorted({placed.link for placed in of.shapes} - {0}):
        found = matrix(browser, ["links", str(link)])
        errors.append(np.abs(found[:3, :3] - of.R[link]).max())
        errors.append(np.abs(found[:3, 3] - of.t_links[link]).max())
    for j, contact in enumerate(of.contacts):
        found = matrix(browser, ["forces", str(j)])
        errors.append(np.abs(found[:3, 3] - contact.beta).max())
        errors.append(np.abs(found[:3, 2] - scale * contact.force).max())
    return float(max(errors))


def main() -> None:
    """Every scene."""
    with TemporaryDirectory() as temporary:
        folder = Path(sys.argv[1] if len(sys.argv) > 1 else temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for name, settings in SCENES.items():
            check_scene(name, settings, folder)


if __name__ == "__main__":
    main()
