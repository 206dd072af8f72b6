"""The page of the study of second-order simulators: its tables and its figure."""

from collections.abc import Iterator
from typing import Any

from quasistatic_ref.lab.figures.labels import label_axes, legend_below
from quasistatic_ref.lab.log import Record, records_read
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.optional.show.figures import Figure, panels
from quasistatic_ref.optional.show.figures.style import scaled
from validation.programs.engines.second_order import STUDY
from validation.tools.scripts import RESULTS

ROWS = RESULTS / "second_order.jsonl"
SCENES = {
    "lift": "lift",
    "push": "centric push",
    "off_centre_push": "off-centre push",
}
DRAWN = {
    ("quasistatic_ref", "uncertified"): ("o-", "black"),
    ("mujoco", "implicitfast, elliptic, impratio 100, solref 5 ms"): ("s-", "0.45"),
    ("mujoco", "implicitfast, elliptic, impratio 100, solref 5 ms, implicit spring"): (
        "s--",
        "0.45",
    ),
    ("drake", "point, sap"): ("^--", "0.7"),
    ("drake", "point, lagged, stiction tolerance 0.01 mm/s"): ("^-", "0.7"),
}
DRAWN_SPEEDS = (0.01, 0.1)
LARGEST = 0.1
"""Larger errors are drawn there: the body was lost [m]."""


def rows() -> list[Record]:
    """The committed rows."""
    return list(records_read(ROWS)[1:])


def rows_with(**fields: Any) -> list[Record]:
    """Rows with these values of their fields."""
    return [row for row in rows() if all(row[name] == value for name, value in fields.items())]


def series(found: list[Record], scene: str) -> Iterator[tuple[str, str, float, list[Record]]]:
    """Engine, setting, speed, and the runs of the grid by falling time step."""
    for engine, settings in STUDY["engines"].items():
        for setting in settings:
            for speed in STUDY["speeds"]:
                of = (scene, engine, setting, speed)
                own = [
                    row for row in found
                    if (row["scene"], row["engine"], row["setting"], row["speed"]) == of
                    and row["h"] in STUDY["steps"]
                ]  # fmt: skip
                yield engine, setting, speed, sorted(own, key=lambda row: -row["h"])


def span(own: list[Record], verdict: str) -> str:
    """Time steps with a verdict, as intervals of neighbours [ms]: "all", "0.5 to 2, 10" or "-"."""
    steps = sorted(row["h"] for row in own)
    good = {row["h"] for row in own if row[verdict]}
    if len(good) == len(steps):
        return "all"
    parts = []
    for before, h in zip([None, *steps], steps, strict=False):
        if h in good:
            if before in good:
                parts[-1].append(h)
            else:
                parts.append([h])
    words = [
        f"{1e3 * part[0]:g}" if len(part) == 1 else f"{1e3 * part[0]:g} to {1e3 * part[-1]:g}"
        for part in parts
    ]
    return ", ".join(words) or "-"


def tables(found: list[Record]) -> str:
    """Time steps with which the body is held, and with which all is right [ms], scene by scene."""
    names = labels()
    lines = ["<!-- Written by python -m validation.make.second_order. -->", ""]
    lines += [*(f"- {name}: {setting}" for (_, setting), name in names.items()), ""]
    for scene, title in SCENES.items():
        cells = {}
        for engine, setting, _, own in series(found, scene):
            held = span(own, "holds")
            right = span(own, "right")
            cells.setdefault(names[engine, setting], []).append(f"{held}; **{right}**")
        head = ("setting", *(f"{1e3 * speed:g} mm/s" for speed in STUDY["speeds"]))
        lines += [
            f"{title[0].upper()}{title[1:]}: time steps [ms] that hold; **that are right**",
            "",
        ]
        lines += [*markdown_table(head, [(name, *words) for name, words in cells.items()]), ""]
    return "\n".join(lines)


def labels() -> dict[tuple[str, str], str]:
    """A short name of each setting, by engine and setting: the engine with a letter."""
    return {
        (engine, setting): f"{engine.removesuffix('_ref')} {letter}"
        for engine, settings in STUDY["engines"].items()
        for letter, setting in zip("ABCDEFG", settings, strict=False)
    }


def figure(within: Any = None) -> Figure:
    """Error against cost, a panel for each scene and for each of two speeds.

    Parameters
    ----------
    within : Axes or SubFigure, optional
        Where to draw; a figure of its own by default.
    """
    found = rows()
    page, grid = panels(6.3, 4.6, len(SCENES), rows=len(DRAWN_SPEEDS), within=within, narrow=0,
                        sharex=True, sharey=True)  # fmt: skip
    places = [(speed, scene) for speed in DRAWN_SPEEDS for scene in SCENES]
    for axes, (speed, scene) in zip(grid, places, strict=True):
        for engine, setting, at, own in series(found, scene):
            if at != speed or (engine, setting) not in DRAWN:
                continue
            mark, colour = DRAWN[engine, setting]
            cost = [row["cost"] for row in own]
            error = [1e3 * min(row["way"], LARGEST) for row in own]
            axes.loglog(cost, error, mark, color=colour, markersize=scaled(3), linewidth=0.8,
                        label=f"{engine}: {setting}")  # fmt: skip
        axes.axhline(1e3 * STUDY["thresholds"]["pose"]["way"], color="black", linestyle=":")
        below = speed == DRAWN_SPEEDS[-1]
        left = scene == next(iter(SCENES))
        label_axes(
            axes,
            "cost [ms a simulated s]" if below else "",
            "error of the place [mm]" if left else "",
            f"{SCENES[scene]}, {1e3 * speed:g} mm/s",
            key=False,
        )
    legend_below(grid, grid[0].get_legend_handles_labels()[0])
    return page
