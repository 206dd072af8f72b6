"""What pages do in a browser: their layout, the viewer's places, the answers of draggable figures.

Run ``python -m validation.tools.check_in_browser SITE`` with a built site, the packages playwright
and meshcat, and Debian's package chromium. Every page is opened offline; an error in its console or
a request to the network is a fault. Exit status 1 if there is a fault.
"""

import io
import re
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from playwright.sync_api import Page, sync_playwright

from quasistatic_ref import load_scenario, solve_step, trajectory_read
from quasistatic_ref.cli.main import main as command
from quasistatic_ref.lab.scenes.pinch import pinch_step
from quasistatic_ref.lab.scenes.rigid import point_step, sphere_step
from quasistatic_ref.optional.show.figures.draw import force_scale
from quasistatic_ref.optional.show.figures.moments import Moment, focus, frames, middle
from quasistatic_ref.optional.show.figures.viewer import FRAMES_PER_SECOND, LONGEST
from quasistatic_ref.optional.show.figures.visuals import visuals
from validation.tools.scripts import ROOT

WIDTHS = (360, 1280)
"""Of a small phone and of a small laptop [px]."""
HEIGHT = 900
LISTING = "_modules"
"""The folder of listings of source, which share one frame: the first one stands for all."""
SCENES = {"bunny_grasp": "steps=120", "peg_in_hole": "steps=100", "panda_push": "steps=30"}
"""Of the viewer."""
PLACE = 1e-6
"""Of positions [m] and matrices [-]: three.js keeps keyframes in float32."""
Z_UP = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
"""From the frame of three.js, whose y is up, to the world's."""
GRAVITY = 9.81
H = 0.01
SAME = 1e-9
"""Largest relative difference: both are closed forms, or exact answers."""
SETTLED = 200
"""Steps after which the gap no longer changes: it loses a fourth at least in each."""

BEYOND = """
() => {
  const width = document.documentElement.clientWidth + 1.5;  // rounding
  const scrolls = e => ['auto', 'scroll'].includes(getComputedStyle(e).overflowX);
  const inside = '.sidebar-drawer, .toc-drawer, .skip-to-content, .visually-hidden,'
    + 'mjx-container, svg *';
  const beyond = [];
  const look = element => {
    if (element.matches(inside) || scrolls(element)) return;
    const box = element.getBoundingClientRect();
    if (box.width && box.right > width) beyond.push(element.outerHTML.slice(0, 80));
    else for (const child of element.children) look(child);
  };
  look(document.body);
  return beyond;
}
"""
"""JavaScript: what reaches out of the window and stands in no box that scrolls."""


@contextmanager
def offline_page() -> Iterator[tuple[Page, list[str]]]:
    """A page of a browser without network, and what goes wrong in it."""
    faults = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
        )
        page = browser.new_context(offline=True).new_page()

        def requested(url: str) -> None:
            if not url.startswith(("file:", "data:", "blob:")):
                faults.append(f"{page.url} asks for {url}")

        def logged(kind: str, text: str) -> None:
            if kind == "error":
                faults.append(f"{page.url}: {text}")

        page.on("request", lambda request: requested(request.url))
        page.on("console", lambda message: logged(message.type, message.text))
        page.on("pageerror", lambda error: faults.append(f"{page.url}: {error}"))
        yield page, faults
        browser.close()


def layout_faults(page: Page, site: Path) -> Iterator[str]:
    """What is wider than the window, of every page of the site."""
    paths = [path for path in sorted(site.rglob("*.html")) if "_static" not in path.parts]
    listings = [path for path in paths if LISTING in path.parts]
    for path in [path for path in paths if path not in listings[1:]]:
        page.goto(path.as_uri())
        page.wait_for_function("!window.MathJax?.startup || MathJax.startup.promise.then(() => 1)")
        for width in WIDTHS:
            page.set_viewport_size({"width": width, "height": HEIGHT})
            for element in page.evaluate(BEYOND):
                yield f"{path.relative_to(site)} at {width} px: {element}"


def viewer_faults(page: Page) -> Iterator[str]:
    """Links and forces in the page of ``run --view`` that are not where the trajectory has them."""
    for name, setting in SCENES.items():
        with TemporaryDirectory() as temporary:
            folder = Path(temporary)
            with redirect_stdout(io.StringIO()):
                command(["run", name, "--view", "--set", setting, "--out", str(folder)])
            scenario = load_scenario(name, [setting])
            run = trajectory_read(folder / f"{name}.npz")
            page.goto((folder / f"{name}.html").as_uri())
            page.wait_for_function("typeof viewer !== 'undefined' && viewer.animator.duration > 0")
        moments, fps = frames(scenario, run, FRAMES_PER_SECOND)
        centre, half = middle(focus(moments, visuals(scenario)))
        scale = force_scale(moments, None, half, LONGEST)
        page.wait_for_function("viewer.animator.time > 0")  # it plays by itself
        page.evaluate("viewer.animator.pause()")
        pictures = []
        for k in (0, len(moments) // 2, len(moments) - 1):
            page.evaluate(f"(viewer.animator.seek({k / fps!r}), viewer.render())")
            far = largest_distance(page, moments[k], centre, scale)
            pictures.append(page.screenshot())
            if far > PLACE:
                yield f"{name}: something of frame {k} is {far:.1e} m from its place"
        if pictures[0] == pictures[-1]:
            yield f"{name}: nothing moves"


def largest_distance(page: Page, moment: Moment, centre: np.ndarray, scale: float) -> float:
    """Largest difference of any link's pose or contact's force from those of a moment.

    The page's origin is the centre of what is looked at.
    """
    errors = [0.0]
    for link in sorted({placed.link for placed in moment.shapes} - {0}):
        M = matrix(page, ["meshcat", "links", str(link)])
        errors.append(np.abs(M[:3, :3] - moment.R[link]).max())
        errors.append(np.abs(M[:3, 3] + centre - moment.t_links[link]).max())
    for j, contact in enumerate(moment.contacts):
        M = matrix(page, ["meshcat", "forces", str(j)])
        errors.append(np.abs(M[:3, 3] + centre - contact.beta).max())
        errors.append(np.abs(M[:3, 1] - scale * contact.force).max())
    return float(max(errors))


def matrix(page: Page, path: list[str]) -> np.ndarray:
    """Matrix of a node in the world whose z is up, shape (4, 4)."""
    node = f"viewer.scene_tree.find({path}).object"
    entries = page.evaluate(
        f"({node}.updateWorldMatrix(true, false), [...{node}.matrixWorld.elements])"
    )
    return Z_UP @ np.array(entries).reshape(4, 4).T


def set_sliders(page: Page, **values: float) -> dict:
    """What the page of draggable figures answers after its sliders have been moved."""
    for name, value in values.items():
        page.evaluate(
            f"(at('{name}').value = {value}, at('{name}').dispatchEvent(new Event('input')))"
        )
    return dict(page.evaluate("answers"))


def drag(page: Page, figure: str, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Drag the pointer from a place of a figure to another, in the figure's own pixels."""
    element = page.locator(f"#{figure}")
    element.scroll_into_view_if_needed()
    box = element.bounding_box()
    pixel = box["width"] / 480
    page.mouse.move(box["x"] + pixel * start[0], box["y"] + pixel * start[1])
    page.mouse.down()
    page.mouse.move(box["x"] + pixel * end[0], box["y"] + pixel * end[1])
    page.mouse.up()


def bowl_faults(page: Page) -> Iterator[str]:
    """A point that is pushed, on both sides of the threshold."""
    for push, mu_v in ((3.0, 0.5), (8.0, 0.5), (-8.0, 0.5), (4.0, 0.25), (12.0, 1.0), (5.0, 0.0)):
        shown = set_sliders(page, push=push, mu_v=mu_v)["bowl"]
        step = point_step(1.0, (push, 0.0, -GRAVITY), mu_v, 0.0, H)
        exact = solve_step(step).delta_q[[0, 2]]
        if np.abs(exact - shown).max() > SAME * H**2 * GRAVITY:
            yield f"push {push}, mu_v {mu_v}: {shown}, not {exact}"


def section_faults(page: Page) -> Iterator[str]:
    """Loads that some cones hold, and a load that is dragged."""
    for f_1, tau in ((0.3, 0.4), (0.6, 0.6), (0.9, 0.9), (1.2, 0.0), (-0.5, 0.49), (0.5, 0.51)):
        for cone, held in set_sliders(page, f_1=f_1, tau=tau)["section"].items():
            wrench = (0.5 * f_1, 0.0, -1.0, 0.0, 0.0, 0.02 * tau)  # on 1 N
            step = sphere_step(0.1, 1e-4, 0.0, wrench, mu_v=0.5, mu_omega=0.02, phi=0.0, h=H)
            still = np.abs(solve_step(step.replace(cone=cone)).delta_q).max() < 1e-12
            if still != held:
                yield f"{cone} at {f_1, tau}: {held}, not {still}"
    start, end = ((240 + 130 * f_1, 200 - 130 * tau) for f_1, tau in ((0.6, 0.6), (-0.3, 0.2)))
    set_sliders(page, f_1=0.6, tau=0.6)
    drag(page, "section", start, end)
    load = page.evaluate("[value('f_1'), value('tau')]")
    if np.abs(np.subtract(load, [-0.3, 0.2])).max() > 0.02:
        yield f"the load is dragged to {load}, not to (-0.3, 0.2)"


def lift_faults(page: Page) -> Iterator[str]:
    """The layer on which a sphere settles, step after step."""
    for h, share in ((10.0, 2.0), (5.0, 2.0), (10.0, 5.0), (20.0, 0.9)):
        gap = set_sliders(page, h=h, share=share)["lift"]
        wrench = (0, 0, -0.3 * GRAVITY, 0, 0, share * 0.01 * 0.3 * GRAVITY)
        phi = 0.0
        for _ in range(SETTLED):
            step = sphere_step(
                0.3, 8e-5, 0.05, wrench, mu_v=1.0, mu_omega=0.01, phi=phi, h=h / 1000
            )
            phi += float(solve_step(step).delta_q[2])
        if abs(gap - phi) > SAME * 1e-3:
            yield f"h = {h} ms, share {share}: a layer of {gap}, not {phi}"


def bar_faults(page: Page) -> Iterator[str]:
    """A bar between two fingers, held by (R21): by its sliders, a handle and a key."""
    names = ("lever", "squeeze", "mu_omega", "mu_v_bar")
    for values in (
        (40, 4, 20, 0.5), (42, 4, 20, 0.5), (-42, 4, 20, 0.5), (-70, 8, 30, 1), (10, 1.9, 20, 0.5),
        (0, 2, 0, 0.5), (0, 1.95, 20, 0.5),
    ):  # fmt: skip
        set_sliders(page, **dict(zip(names, values, strict=True)))
        yield from bar_text_faults(page)
        lever, squeeze, mu_omega, mu_v = values
        step = pinch_step(squeeze, lever / 1000, mu_v, mu_omega / 1000, m=0.2)
        moves = np.abs(step.contacts.J @ solve_step(step).delta_q).max()
        verb, _ = bar_verdict(dict(zip(names, values, strict=True)))
        if (moves < 1e-12) != (verb == "holds"):
            yield f"bar {values}: {verb}, but it moves by {moves}"
    set_sliders(page, lever=40, squeeze=4, mu_omega=20, mu_v_bar=0.5)
    drag(page, "bar", (340, 62), (390, 62))
    lever = page.evaluate("value('lever')")
    if abs(lever - 60) > 0.2:
        yield f"the lever is dragged to {lever}, not to 60"
    page.locator("#mu_omega").focus()
    page.keyboard.press("End")
    if page.evaluate("value('mu_omega')") != 30:
        yield "the key End does not move a slider"
    yield from bar_text_faults(page)


def bar_verdict(bar: dict[str, float]) -> tuple[str, list[float]]:
    """The verb of (R21) for a bar of 0.2 kg; what weight and torque need, and what is left [N]."""
    u = 0.2 * GRAVITY / (2 * bar["mu_v_bar"])
    torque = 0.2 * GRAVITY * abs(bar["lever"]) / 2  # N mm, over mu_omega in mm
    w = torque / bar["mu_omega"] if torque else 0.0
    left = bar["squeeze"] - u - w
    if left >= 0:
        return "holds", [u, w, left]
    return ("turns" if u <= bar["squeeze"] else "slips"), [u, w, -left]


def bar_text_faults(page: Page) -> Iterator[str]:
    """The page's words about the bar at its sliders, where they are not those of (R21)."""
    names = ("lever", "squeeze", "mu_omega", "mu_v_bar")
    bar = {name: page.evaluate(f"value('{name}')") for name in names}
    text = page.evaluate("at('bar_said').value")
    verb, expected = bar_verdict(bar)
    shown = [float(number) for number in re.findall(r"([\d.]+) N\b", text)]
    same = len(shown) == 3 and np.allclose(shown, expected, rtol=0, atol=0.00051)  # three decimals
    if f"bar {verb}" not in text or not same:
        yield f"{bar}: {text!r}, not {verb}, {expected}"


def draggable_faults(page: Page) -> Iterator[str]:
    """Answers of the figures that are dragged, against exact answers."""
    page.goto((ROOT / "docs" / "draggable" / "draggable.html").as_uri())
    for faults in (bowl_faults, section_faults, lift_faults, bar_faults):
        yield from faults(page)


def main() -> int:
    """Print every fault of the site, of the viewer and of the draggable figures."""
    if len(sys.argv) != 2:
        sys.exit("usage: python -m validation.tools.check_in_browser SITE")
    site = Path(sys.argv[1]).resolve()
    with offline_page() as (page, faults):
        faults += layout_faults(page, site)
        faults += viewer_faults(page)
        faults += draggable_faults(page)
    print("\n".join(faults) or "pages fit, and show and answer what they should")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
