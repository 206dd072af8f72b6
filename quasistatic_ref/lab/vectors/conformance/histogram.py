"""How many digits of each answer are right, layer by layer, as SVG: equal bytes each time."""

from collections.abc import Sequence
from math import floor
from typing import Final

from quasistatic_ref.lab.vectors.check.report import LayerReport
from quasistatic_ref.lab.vectors.check.verdict import DIGITS, FAILED, Verdict

BINS: Final = 16
"""One for each digit; 16, all that float64 holds, is in the last."""
LEFT, STEP, HEIGHT, GAP, TOP, FOOT = 84, 34, 44, 14, 26, 44
"""Place of the first bar, width and height of bars, between layers, above and below them [px]."""
KINDS: Final = (("right", "#0072b2"), ("to fewer digits", "#e69f00"), ("wrong", "#c1272d"))
"""What bars are made of, from below; the two that are no plain success are striped, too."""


def counts(verdicts: Sequence[Verdict]) -> list[list[int]]:
    """Of each kind, how many answers have so many digits: those that can be compared by number.

    Parameters
    ----------
    verdicts : sequence of Verdict
        Of a layer.

    Returns
    -------
    list of list of int
        One for each of KINDS.
    """
    found = [[0] * BINS for _ in KINDS]
    for verdict in verdicts:
        if verdict.digits is not None:
            kind = 2 if verdict.verdict == FAILED else int(verdict.loose)
            found[kind][min(floor(verdict.digits), int(DIGITS) - 1)] += 1
    return found


def histogram(layers: Sequence[LayerReport]) -> str:
    """The picture: a row of bars for each layer, each row to its own scale.

    Parameters
    ----------
    layers : sequence of LayerReport
        Those that are answered.
    """
    width = LEFT + BINS * STEP + 20
    height = TOP + len(layers) * (HEIGHT + GAP) + FOOT
    parts = [*_legend(), *_axis(len(layers))]
    for number, layer in enumerate(layers):
        parts += _row(layer.layer, counts(layer.verdicts), TOP + number * (HEIGHT + GAP))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
        f'height="{height}" font-family="sans-serif" font-size="12" fill="#111111">'
        f"{_stripes()}{''.join(parts)}</svg>\n"
    )


def _stripes() -> str:
    one = (
        '<pattern id="kind{0}" width="5" height="5" patternUnits="userSpaceOnUse" '
        'patternTransform="rotate({1})"><rect width="5" height="5" fill="{2}"/>'
        '<rect width="1.5" height="5" fill="#ffffff"/></pattern>'
    )
    patterns = (one.format(i, 45 if i == 1 else -45, KINDS[i][1]) for i in (1, 2))
    return f"<defs>{''.join(patterns)}</defs>"


def _fill(kind: int) -> str:
    return f"url(#kind{kind})" if kind else KINDS[0][1]


def _text(x: float, y: float, words: str, anchor: str = "middle") -> str:
    return f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}">{words}</text>'


def _legend() -> list[str]:
    parts = []
    x = LEFT
    for kind, (words, _) in enumerate(KINDS):
        parts.append(f'<rect x="{x}" y="3" width="12" height="12" fill="{_fill(kind)}"/>')
        parts.append(_text(x + 17, 13, words, "start"))
        x += 40 + 7 * len(words)
    return parts


def _axis(rows: int) -> list[str]:
    y = TOP + rows * (HEIGHT + GAP)
    ticks = (_text(LEFT + STEP * i, y + 10, str(i)) for i in range(0, BINS + 1, 2))
    return [
        *ticks,
        _text(LEFT + STEP * BINS / 2, y + 30, "correct digits [-], fewest of each answer"),
    ]


def _row(name: str, kinds: list[list[int]], top: int) -> list[str]:
    """The bars of a layer, each with its count above."""
    base = top + HEIGHT
    totals = [sum(column) for column in zip(*kinds, strict=True)]
    scale = (HEIGHT - 14) / max(1, *totals)
    parts = [
        _text(LEFT - 8, base - 4, name, "end"),
        f'<path d="M{LEFT} {base + 0.5}h{BINS * STEP}" stroke="#777777" fill="none"/>',
    ]
    for i, total in enumerate(totals):
        y = float(base)
        for kind, column in enumerate(kinds):
            size = scale * column[i]
            y -= size
            if column[i]:
                parts.append(
                    f'<rect x="{LEFT + STEP * i + 3}" y="{y:.2f}" width="{STEP - 6}" '
                    f'height="{size:.2f}" fill="{_fill(kind)}"/>'
                )
        if total:
            parts.append(_text(LEFT + STEP * (i + 0.5), y - 2, str(total)))
    return parts
