"""Whether a figure can be read on a page: units, text, lines distinguished without colour."""

import re
from itertools import combinations

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.collections import PathCollection
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch
from matplotlib.text import Text

from quasistatic_ref.optional.show.figures.style import DRAWING, PAGE, figure_style

LEAST = 7.0
"""Least size of text where the figure is printed on a page [pt]."""

SLACK = 1.0
"""How far text may reach out of a figure [pixels]: boxes are rounded."""

INNER = 0.2
"""Rim of a box of text in which there are no letters, over the size of the font [-]."""

GREY = 0.15
"""Least difference in luminance of two fills that grey can tell apart [-]; black to white is 1."""

UNIT = re.compile(r"\[[^\]]+\]$")
NUMBER = re.compile(
    r"^(\\mathdefault|\\times|[-+\u2212.$^{}e\s])*\d(\\times|[-+\u2212.$^{}e\d\s])*$"
)


def faults(figure, style="paper"):
    """What is wrong with a figure, a sentence each; none if it is legible.

    Parameters
    ----------
    figure : Figure
    style : str or Path
        The one that it was drawn in. The figure is printed as wide as a page at most; where the
        style's ``figure.figsize`` is wider, so is its page, and it is seen from farther away.
    """
    with figure_style(style):
        figure.canvas.draw()
        whole = max(PAGE, float(plt.rcParams["figure.figsize"][0]))
        shrunk = min(1.0, whole / figure.get_tightbbox().width)
        found = list(_small_text(figure, shrunk, LEAST * whole / PAGE))
        found += _lost_text(figure)
        for k, axes in enumerate(figure.axes):
            where = axes.get_title() or axes.get_title("right") or axes.get_title("left")
            where = f"axes {k} ({where})" if where else f"axes {k}"
            found += [f"{where}: {fault}" for fault in (*_labels(axes), *_alike(axes))]
    return found


def _drawn_texts(figure):
    """Every text that is drawn: no empty one, none of a tick beyond the ends of its axis."""
    beyond = set()
    for axes in figure.axes:
        for _, axis in _axis_map(axes):
            low, high = sorted(axis.get_view_interval())
            slack = 1e-9 * (high - low)
            for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
                if not axes.axison or not low - slack <= tick.get_loc() <= high + slack:
                    beyond |= {tick.label1, tick.label2}
    texts = (t for t in figure.findobj(Text) if t.get_visible() and t not in beyond)
    return [text for text in texts if text.get_text().strip()]


def _lost_text(figure):
    """Text that reaches out of the figure, and text upon text."""
    width, height = figure.bbox.size
    level = []
    for text in _drawn_texts(figure):
        box = text.get_window_extent()
        name = repr(text.get_text())
        for (low, high), most, way in (
            (box.intervalx, width, "across"),
            (box.intervaly, height, "up"),
        ):
            if low < -SLACK or high > most + SLACK:
                yield f"{name} reaches from {low:.0f} to {high:.0f} of {most:.0f} pixels {way}"
        if text.get_rotation() % 90 == 0:  # the box of slanted text is larger than the text
            rim = INNER * float(text.get_fontsize()) * figure.dpi / 72
            level.append((name, box.padded(-rim)))
    for (one, here), (other, there) in combinations(level, 2):
        if here.overlaps(there):
            yield f"{one} and {other} lie on each other"


def _axis_map(axes):
    names = "xyz" if axes.name == "3d" else "xy"
    return [(name, getattr(axes, f"{name}axis")) for name in names]


def _small_text(figure, shrunk, least):
    for text in _drawn_texts(figure):
        size = float(text.get_fontsize()) * shrunk
        if size < least - 0.01:
            yield f"{text.get_text()!r} is printed at {size:.1f} pt, less than {least:g}"


def _labels(axes):
    """Axes whose ticks bear numbers, and whose label does not end with a unit."""
    if not axes.axison:
        return
    for name, axis in _axis_map(axes):
        ticks = [t.get_text() for t in axis.get_ticklabels() if t.get_visible()]
        if not any(NUMBER.match(text) for text in ticks):
            continue  # no ticks, or categories: names need no unit
        if not UNIT.search(axis.get_label_text()) and not _labelled_by_sharing(axes, name):
            yield f"the label {axis.get_label_text()!r} of {name} does not end with a [unit]"


def _labelled_by_sharing(axes, name):
    """Whether axes that share this axis bear its label, and these do not show its ticks' text."""
    if name == "z":
        return False
    group = getattr(axes, f"get_shared_{name}_axes")()
    return any(
        UNIT.search(getattr(other, f"get_{name}label")())
        for other in group.get_siblings(axes)
        if other is not axes
    )


def _alike(axes):
    """Pairs that only their colour tells apart."""
    lines = [line for line in axes.lines if line.get_visible() and line.get_gid() != DRAWING]
    for one, other in combinations(lines, 2):
        if _dress(one) == _dress(other) and to_rgb(one.get_color()) != to_rgb(other.get_color()):
            yield f"the lines {one.get_label()!r} and {other.get_label()!r} differ in colour only"
    for kind, members in _fills(axes).items():
        for first, second in combinations(members, 2):
            same = abs(first[1] - second[1]) < GREY and first[2] == second[2]
            if same and first[3] != second[3]:
                yield f"the {kind} {first[0]!r} and {second[0]!r} differ in colour only"


def _dress(line):
    """What a line looks like but for its colour."""
    pattern = vars(line)["_unscaled_dash_pattern"]  # "--" and (0, (..)) alike
    mark = None if line.get_marker() in ("", " ", "None", None) else str(line.get_marker())
    shown = line.get_linestyle() not in ("", " ", "None", "none")
    return (str(pattern) if shown else None), mark, (line.get_fillstyle() if mark else None)


def _fills(axes):
    """Labelled patches and scattered dots: label, luminance, other marks, colour."""
    found = {"patches": [], "dots": []}
    handles, labels = axes.get_legend_handles_labels()
    for handle, label in zip(handles, labels, strict=True):
        first = handle[0] if isinstance(handle, tuple | list) and len(handle) else handle
        if isinstance(first, Patch):
            colour = first.get_facecolor()
            found["patches"].append((label, _luminance(colour), first.get_hatch(), colour))
        elif isinstance(first, PathCollection):
            colour = tuple(np.ravel(first.get_facecolor())[:3]) or (1.0, 1.0, 1.0)
            shape = np.shape(first.get_paths()[0].vertices), tuple(first.get_sizes()[:1])
            found["dots"].append((label, _luminance(colour), shape, colour))
    return found


def _luminance(colour):
    """How light a colour is in grey [-]."""
    red, green, blue = to_rgb(colour)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue
