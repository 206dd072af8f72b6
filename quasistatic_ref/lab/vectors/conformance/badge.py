"""A badge as SVG: one line that says against what, and exactly what was passed.

The file is the whole report: its description has all sentences, its metadata the record. Equal
bytes for equal results. Texts are given their widths, so that no font of the reader's makes
them overlap.
"""

import json
from html import escape

from quasistatic_ref.formats.quoting import aligned
from quasistatic_ref.lab.vectors.conformance.conformance import Conformance

LABEL, GREEN, AMBER, RED, GREY = "#444444", "#1a7f37", "#8f5a00", "#b42318", "#57606a"
"""White on each has a contrast of more than 4.5."""
NARROW = "iIjltf.,:;/ ()|'"
WIDE = "mwMW%@"
WIDTHS = {"narrow": 3.9, "wide": 9.6, "digit": 7.0, "other": 6.7}
"""Of letters at 11 px [px]."""
MARGIN = 7.0
"""On each side of a text [px]."""


def colour(conformance: Conformance) -> str:
    """GREEN: whole and right; AMBER: to fewer digits, or in part; RED: not; GREY: changed cases."""
    if conformance.changed_layers:
        return GREY
    if not conformance.report.ok:
        return RED
    return GREEN if conformance.complete else AMBER


def width(text: str) -> float:
    """About how wide a text is [px]."""
    kinds = (
        "narrow" if c in NARROW else "wide" if c in WIDE else "digit" if c.isdigit() else "other"
        for c in text
    )
    return round(sum(WIDTHS[kind] for kind in kinds), 1)


def badge(conformance: Conformance) -> str:
    """The badge.

    Parameters
    ----------
    conformance : Conformance
    """
    label = conformance.label
    message = conformance.message
    parts = (width(label), width(message))
    left, right = (round(part + 2 * MARGIN, 1) for part in parts)
    whole = escape(f"{conformance.implementation}: {label}: {message}")
    shapes = (
        f'<rect width="{left + right:.1f}" height="20" rx="3" fill="{LABEL}"/>'
        f'<path d="M{left:.1f} 0h{right - 3:.1f}a3 3 0 0 1 3 3v14a3 3 0 0 1-3 3h-{right - 3:.1f}z" '
        f'fill="{colour(conformance)}"/>'
    )
    texts = (
        f'<text x="{x:.1f}" y="14" textLength="{part:.1f}">{escape(text)}</text>'
        for x, part, text in zip((MARGIN, left + MARGIN), parts, (label, message), strict=True)
    )
    said = "\n".join([*aligned(conformance.report.rows), *conformance.sentences])
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + right:.1f}" height="20" '
        f'viewBox="0 0 {left + right:.1f} 20" role="img" aria-label="{whole}">'
        f"<title>{whole}</title>\n<desc>{escape(said)}</desc>\n"
        f"<metadata>{escape(json.dumps(conformance.record))}</metadata>\n{shapes}"
        '<g fill="#ffffff" font-family="Verdana,DejaVu Sans,Geneva,sans-serif" font-size="11">'
        f"{''.join(texts)}</g></svg>\n"
    )
