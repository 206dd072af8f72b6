"""Drag the figures of ``docs/draggable`` in a headless Chromium, and compare with exact answers.

Run ``python -m validation.tools.check_draggable [FOLDER]``; screenshots stay in FOLDER, if it is
given. Sliders are set and the load is dragged as a hand does; the page is offline. Exit status 1 at
the first thing that is wrong, a missing browser included: nothing is skipped.
"""

import sys
from pathlib import Path

import numpy as np

from quasistatic_ref.lab.scenes.rigid import point_step, sphere_step
from quasistatic_ref.solve.solve import solve_step
from validation.tools.browser import Browser, check
from validation.tools.scripts import ROOT

PAGE = ROOT / "docs" / "draggable" / "draggable.html"
GRAVITY = 9.81
H = 0.01
SAME = 1e-9
"""Largest difference, relative to the free motion: both are closed forms, or exact answers."""
SETTLED = 200
"""Steps after which the gap no longer changes: it loses a fourth at least in each."""


def slid(browser: Browser, **values: float) -> dict:
    """What the page answers after its sliders have been moved."""
    for name, value in values.items():
        browser.value(
            f"(at('{name}').value = {value}, at('{name}').dispatchEvent(new Event('input')))"
        )
    return dict(browser.value("answers"))


def check_bowl(browser: Browser) -> None:
    """The answer of a point, at pushes on both sides of the threshold."""
    for push, mu_v in ((3.0, 0.5), (8.0, 0.5), (-8.0, 0.5), (4.0, 0.25), (12.0, 1.0), (5.0, 0.0)):
        dx, dz = slid(browser, push=push, mu_v=mu_v)["bowl"]
        step = point_step(1.0, (push, 0.0, -GRAVITY), mu_v, 0.0, H)
        found = solve_step(step).delta_q[[0, 2]]
        far = float(np.abs(found - [dx, dz]).max())
        check(far > SAME * H**2 * GRAVITY, f"push {push}, mu_v {mu_v}: {dx, dz}, not {found}")


def check_section(browser: Browser) -> None:
    """Loads that some cones hold: by their sliders, then by the pointer."""
    for f_1, tau in ((0.3, 0.4), (0.6, 0.6), (0.9, 0.9), (1.2, 0.0), (-0.5, 0.49), (0.5, 0.51)):
        held = slid(browser, f_1=f_1, tau=tau)["section"]
        for cone, says in held.items():
            wrench = (0.5 * f_1, 0.0, -1.0, 0.0, 0.0, 0.02 * tau)  # on 1 N
            step = sphere_step(
                0.1, 1e-4, 0.0, wrench, mu_v=0.5, mu_omega=0.02, phi=0.0, h=H
            ).replace(cone=cone)
            still = bool(np.abs(solve_step(step).delta_q).max() < 1e-12)
            check(still != says, f"{cone} at {f_1, tau}: {says}, not {still}")
    browser.value("at('section').scrollIntoView()")
    box = browser.value(
        "(({left, top, width}) => ({left, top, width}))(at('section').getBoundingClientRect())"
    )
    scale = box["width"] / 480
    for kind, f_1, tau in (("mousePressed", 0.6, 0.6), ("mouseMoved", -0.3, 0.2)):
        x = box["left"] + scale * (240 + 130 * f_1)
        y = box["top"] + scale * (200 - 130 * tau)
        browser.ask(
            "Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1
        )
    found = browser.value("[value('f_1'), value('tau')]")
    off = float(np.abs(np.array(found) - [-0.3, 0.2]).max())
    check(off > 0.02, f"the load is at {found}, not where it was dragged, (-0.3, 0.2)")


def check_lift(browser: Browser) -> None:
    """The layer on which a sphere settles, step after step."""
    for h, share in ((10.0, 2.0), (5.0, 2.0), (10.0, 5.0), (20.0, 0.9)):
        gap = slid(browser, h=h, share=share)["lift"]
        phi = 0.0
        for _ in range(SETTLED):
            wrench = (0, 0, -0.3 * GRAVITY, 0, 0, share * 0.01 * 0.3 * GRAVITY)
            step = sphere_step(
                0.3, 8e-5, 0.05, wrench, mu_v=1.0, mu_omega=0.01, phi=phi, h=h / 1000
            )
            phi += float(solve_step(step).delta_q[2])
        check(abs(gap - phi) > SAME * 1e-3, f"h = {h} ms, share {share}: {gap}, not {phi}")


def main() -> None:
    """Open, slide, drag."""
    with Browser() as browser:
        browser.open(PAGE)
        check_bowl(browser)
        check_section(browser)
        check_lift(browser)
        if len(sys.argv) > 1:
            Path(sys.argv[1]).mkdir(parents=True, exist_ok=True)
            (Path(sys.argv[1]) / "draggable.png").write_bytes(browser.screenshot(whole=True))
        check(bool(browser.faults()), "; ".join(browser.faults()))
    print("wedge, cone and layer answer as the package does, and need no network: good")


if __name__ == "__main__":
    main()
