"""Findings as JSON and as the page ``claims.md``."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quasistatic_ref.lab.claims.claim import HOLDS, ClaimResult, Comparison
from quasistatic_ref.lab.markdown import markdown_table

HEAD = """# Claims

Written by `quasistatic-ref validate`. Each row is one quantity over a sweep, shown at its worst
point: its error is relative to the largest term of the formula, or absolute where it has none.
Formulas (R1), (R2), ... are derived in docs/derivations.md.
"""
CHAPTER = re.compile(r"^### (\w+): .*?(?=^##|\Z)", re.MULTILINE | re.DOTALL)
"""The chapter of a claim, up to the next heading."""


def finding_record(finding: ClaimResult) -> dict[str, Any]:
    """One finding as a JSON object."""
    claim = finding.claim
    return {
        "name": claim.name,
        "claim": claim.sentence,
        "where": claim.where,
        "sweep": claim.sweep,
        "engine": claim.engine_version,
        "reason": claim.reason,
        "verdict": finding.verdict,
        "trouble": finding.trouble,
        "comparisons": [_record(c) for c in finding.comparisons or ()],
    }


def _record(c: Comparison) -> dict[str, Any]:
    i = c.worst if c.errors.size else None
    return {
        "what": c.what,
        "points": int(c.errors.size),
        "measured": None if i is None else _finite(c.measured[i]),
        "expected": c.words or (None if i is None else _finite(c.expected[i])),
        "error": None if i is None else _finite(c.errors[i]),
        "tolerance": c.tolerance,
        "holds": c.holds,
    }


def _finite(x: float) -> float | None:
    """A number that JSON holds, or null."""
    return float(x) if np.isfinite(x) else None


def summary(finding: ClaimResult) -> tuple[str, str, str, str]:
    """Verdict and points; error and tolerance of the comparison that is nearest to failing."""
    record = finding_record(finding)["comparisons"]
    if not record:
        return finding.verdict, "-", "-", "-"
    points = sum(c["points"] for c in record)
    # Failures first, then real numbers before equalities that hold bit for bit.
    worst = max(record, key=lambda c: (not c["holds"], _share(c)))
    return finding.verdict, str(points), _short(worst["error"]), _short(worst["tolerance"])


def _share(record: Mapping[str, Any]) -> float:
    error = record["error"]
    tolerance = record["tolerance"]
    return float("inf") if error is None else error / tolerance if tolerance else float(error > 0)


def claims_page(sections: Mapping[str, Sequence[str]]) -> str:
    """The text of ``claims.md``, from the chapters of claims under the titles of their sections.

    Parameters
    ----------
    sections : mapping of str to sequence of str
        Chapters, as :func:`chapter` writes them.
    """
    every = [chapter for chapters in sections.values() for chapter in chapters]
    held = sum(f": {HOLDS}" in chapter.partition("\n")[0] for chapter in every)
    parts = [HEAD, f"{held} of {len(every)} claims hold."]
    for title, chapters in sections.items():
        parts += [f"## {title}", *chapters] if chapters else []
    return "\n\n".join(part.strip("\n") for part in parts) + "\n"


def chapters_of(page: str) -> dict[str, str]:
    """The chapters of a ``claims.md`` by the names of its claims."""
    return {text[1]: text[0] for text in CHAPTER.finditer(page)}


def chapter(finding: ClaimResult) -> str:
    """The chapter of one claim: its sentence, where it stands, and what was measured."""
    record = finding_record(finding)
    engine = f"*Engine:* {record['engine']}. " if record["engine"] else ""
    lines = [
        f"### {record['name']}: {record['verdict']}",
        "",
        record["claim"],
        "",
        f"*Where:* {record['where']}. {engine}*Sweep:* {record['sweep']}. "
        f"*Tolerance:* {record['reason']}",
        "",
    ]
    if record["trouble"]:
        lines += [f"It could not be measured: {record['trouble']}.", ""]
    if record["comparisons"]:
        names = ("quantity", "points", "measured", "expected", "error", "tolerance", "verdict")
        lines += [*markdown_table(names, map(_comparison_row, record["comparisons"])), ""]
    return "\n".join(lines)


def _comparison_row(comparison: Mapping[str, Any]) -> tuple[str, ...]:
    """The line of a comparison."""
    expected = comparison["expected"]
    return (
        comparison["what"],
        str(comparison["points"]),
        _number(comparison["measured"]),
        expected if isinstance(expected, str) else _number(expected),
        _short(comparison["error"]),
        _short(comparison["tolerance"]),
        "holds" if comparison["holds"] else "FAILS",
    )


def _number(x: float | None) -> str:
    return "not a number" if x is None else f"{x:.6g}"


def _short(x: float | None) -> str:
    return "not a number" if x is None else f"{x:.1e}" if x else "0"
