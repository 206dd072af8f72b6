"""Drag the figures of ``docs/draggable`` in a headless Chromium, and compare with exact answers.

Run ``python -m validation.tools.check_draggable [FOLDER]``; screenshots stay in FOLDER, if it is
given. Sliders are set, and the load and the bar's handles are dragged as a hand does; the page is
offline. Exit status 1 at the first thing that is wrong, a missing browser included: nothing is
skipped.
"""

import re
import sys
from pathlib import Path

import numpy as np

from quasistatic_ref import solve_step
from quasistatic_ref.lab.scenes.pinch import pinch_step
from quasistatic_ref.lab.scenes.rigid import point_step, sphere_step
from validation.tools.browser import Browser, check
from validation.tools.scripts import ROOT

PAGE = ROOT / "docs" / "draggable" / "draggable.html"
GRAVITY = 9.81
H = 0.01
SAME = 1e-9
"""Largest difference, relative to the free motion: both are closed forms, or exact answers."""
SETTLED = 200
"""Steps after which the gap no longer changes: it loses a fourth at least in each."""


def answer_after_sliding(browser: Browser, **values: float) -> dict:
    """What the page answers after its sliders have been moved."""
    for name, value in values.items():
        browser.value(
            f"(at('{name}').value = {value}, at('{name}').dispatchEvent(new Event('input')))"
        )
    return dict(browser.value("answers"))


def drag(browser: Browser, figure: str, *places: tuple[float, float]) -> None:
    """Press the pointer at the first place of a figure, in its own pixels, and move to the last."""
    browser.value(f"at('{figure}').scrollIntoView()")
    left, top, width = browser.value(
        f"(({{left, top, width}}) => [left, top, width])(at('{figure}').getBoundingClientRect())"
    )
    kinds = ("mousePressed", *("mouseMoved" for _ in places[1:]), "mouseReleased")
    for kind, (x, y) in zip(kinds, (*places, places[-1]), strict=True):
        at = {"x": left + width / 480 * x, "y": top + width / 480 * y}
        buttons = int(kind != "mouseReleased")
        browser.ask(
            "Input.dispatchMouseEvent",
            type=kind,
            **at,
            button="left",
            buttons=buttons,
            clickCount=1,
        )


def check_bowl(browser: Browser) -> None:
    """The answer of a point, at pushes on both sides of the threshold."""
    for push, mu_v in ((3.0, 0.5), (8.0, 0.5), (-8.0, 0.5), (4.0, 0.25), (12.0, 1.0), (5.0, 0.0)):
        dx, dz = answer_after_sliding(browser, push=push, mu_v=mu_v)["bowl"]
        step = point_step(1.0, (push, 0.0, -GRAVITY), mu_v, 0.0, H)
        found = solve_step(step).delta_q[[0, 2]]
        far = float(np.abs(found - [dx, dz]).max())
        check(far > SAME * H**2 * GRAVITY, f"push {push}, mu_v {mu_v}: {dx, dz}, not {found}")


def check_section(browser: Browser) -> None:
    """Loads that some cones hold: by their sliders, then by the pointer."""
    for f_1, tau in ((0.3, 0.4), (0.6, 0.6), (0.9, 0.9), (1.2, 0.0), (-0.5, 0.49), (0.5, 0.51)):
        held = answer_after_sliding(browser, f_1=f_1, tau=tau)["section"]
        for cone, says in held.items():
            wrench = (0.5 * f_1, 0.0, -1.0, 0.0, 0.0, 0.02 * tau)  # on 1 N
            step = sphere_step(
                0.1, 1e-4, 0.0, wrench, mu_v=0.5, mu_omega=0.02, phi=0.0, h=H
            ).replace(cone=cone)
            still = bool(np.abs(solve_step(step).delta_q).max() < 1e-12)
            check(still != says, f"{cone} at {f_1, tau}: {says}, not {still}")
    drag(
        browser, "section", *((240 + 130 * f, 200 - 130 * t) for f, t in ((0.6, 0.6), (-0.3, 0.2)))
    )
    found = browser.value("[value('f_1'), value('tau')]")
    off = float(np.abs(np.array(found) - [-0.3, 0.2]).max())
    check(off > 0.02, f"the load is at {found}, not where it was dragged, (-0.3, 0.2)")


def check_lift(browser: Browser) -> None:
    """The layer on which a sphere settles, step after step."""
    for h, share in ((10.0, 2.0), (5.0, 2.0), (10.0, 5.0), (20.0, 0.9)):
        gap = answer_after_sliding(browser, h=h, share=share)["lift"]
        phi = 0.0
        for _ in range(SETTLED):
            wrench = (0, 0, -0.3 * GRAVITY, 0, 0, share * 0.01 * 0.3 * GRAVITY)
            step = sphere_step(
                0.3, 8e-5, 0.05, wrench, mu_v=1.0, mu_omega=0.01, phi=phi, h=h / 1000
            )
            phi += float(solve_step(step).delta_q[2])
        check(abs(gap - phi) > SAME * 1e-3, f"h = {h} ms, share {share}: {gap}, not {phi}")


def said_of(bar: dict[str, float]) -> tuple[str, list[float]]:
    """What (R21) says of a bar of 0.2 kg: its verb, and what weight and torque need and is left."""
    N = bar["squeeze"]
    u = 0.2 * GRAVITY / (2 * bar["mu_v_bar"])
    torque = 0.2 * GRAVITY * abs(bar["lever"]) / 2  # N mm, over mu_omega in mm
    w = torque / bar["mu_omega"] if torque else 0.0
    verb = "holds" if u + w <= N else "turns" if u <= N else "slips"
    return verb, [u, w, abs(N - u - w)]


def check_said(browser: Browser) -> str:
    """The verb that the page says of the bar at its sliders; its numbers are those of (R21)."""
    names = ("lever", "squeeze", "mu_omega", "mu_v_bar")
    bar = {name: browser.value(f"value('{name}')") for name in names}
    said = browser.value("at('bar_said').value")
    verb, expected = said_of(bar)
    shown = [float(number) for number in re.findall(r"([\d.]+) N\b", said)]
    same = len(shown) == 3 and np.allclose(shown, expected, rtol=0, atol=0.00051)  # three decimals
    check(f"bar {verb}" not in said or not same, f"{bar}: {said!r}, not {verb}, {expected}")
    return verb


def check_bar(browser: Browser) -> None:
    """A bar in two fingers: by its sliders, by each handle, and by a key."""
    names = ("lever", "squeeze", "mu_omega", "mu_v_bar")
    seen = set()
    for values in (
        (40, 4, 20, 0.5), (42, 4, 20, 0.5), (-42, 4, 20, 0.5), (-70, 8, 30, 1), (10, 1.9, 20, 0.5),
        (0, 2, 0, 0.5), (0, 1.95, 20, 0.5),
    ):  # fmt: skip
        answer_after_sliding(browser, **dict(zip(names, values, strict=True)))
        verb = check_said(browser)
        seen.add(verb)
        lever, squeeze, mu_omega, mu_v = values
        step = pinch_step(squeeze, lever / 1000, mu_v, mu_omega / 1000, m=0.2)
        answer = solve_step(step).delta_q
        moves = np.abs(step.contacts.J @ answer)  # of each contact: along x, y, z; about n
        check((moves.max() < 1e-12) != (verb == "holds"), f"{values}: {verb}, but {moves}")
        # A bar that turns spins and slides at once: both rows of the contact are active.
        both = np.isclose(mu_v * moves[:, 2], mu_omega / 1000 * moves[:, 3], rtol=1e-6, atol=0)
        check(verb == "turns" and not both.all(), f"{values}: not spin and slip at once, {moves}")
    check(seen != {"holds", "turns", "slips"}, f"only {seen} were seen")

    answer_after_sliding(browser, lever=40, squeeze=4, mu_omega=20, mu_v_bar=0.5)
    for name, start, end, becomes, verb in (
        ("lever", (340, 62), (390, 62), 60, "turns"),
        ("squeeze", (340, 335), (380, 335), 5.6, "holds"),
        ("mu_omega", (240, 177), (240, 275), 7.1, "turns"),
    ):
        drag(browser, "bar", start, end)
        found = browser.value(f"value('{name}')")
        check(abs(found - becomes) > 0.2, f"{name} is {found} after a drag, not {becomes}")
        check(
            check_said(browser) != verb, f"after a drag of {name} the bar is not said to be {verb}"
        )
    browser.value("at('mu_omega').focus()")
    for kind in ("keyDown", "keyUp"):
        browser.ask(
            "Input.dispatchKeyEvent", type=kind, key="End", code="End", windowsVirtualKeyCode=35
        )
    check(browser.value("value('mu_omega')") != 30, "the key End does not move a slider")
    check(check_said(browser) != "holds", "a key changes no words")


def check_alone(browser: Browser) -> None:
    """As a lecture includes it, in a phone and in a window: the bar alone, within the width."""
    for width in (340, 400, 1200):
        browser.ask(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=832, deviceScaleFactor=1, mobile=False,
        )  # fmt: skip
        browser.ask("Page.navigate", url=f"{PAGE.as_uri()}?bar")
        browser.until("document.readyState === 'complete' && document.body.className === 'alone'")
        names = browser.value("['bowl', 'section', 'lift', 'bar'].filter(i => at(i).clientWidth)")
        check(names != ["bar"], f"beside the bar there is {names}")
        size = "[document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
        wide, high = browser.value(size)
        check(wide > width or high > 832, f"at {width} px it is {wide} x {high} px")
        check_said(browser)


def main() -> None:
    """Open, slide, drag; the bar also alone, as a lecture shows it."""
    with Browser() as browser:
        browser.open(PAGE)
        check_bowl(browser)
        check_section(browser)
        check_lift(browser)
        check_bar(browser)
        if len(sys.argv) > 1:
            Path(sys.argv[1]).mkdir(parents=True, exist_ok=True)
            (Path(sys.argv[1]) / "draggable.png").write_bytes(browser.screenshot(whole=True))
        check_alone(browser)
        check(bool(browser.faults()), "; ".join(browser.faults()))
    print("wedge, cone, layer and bar answer as the package does, and need no network: good")


if __name__ == "__main__":
    main()
