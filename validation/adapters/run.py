"""Put engines that we did not write to the test of the vectors; writes results.md beside this file.

``python validation/adapters/run.py`` takes a minute. Each engine runs with its default settings.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import coal_adapter
import mujoco_adapter
import pinocchio_adapter
import qpsolvers_adapter
from common import engine_report

from quasistatic_ref.lab.vectors.check.report import LayerReport

HERE = Path(__file__).parent
HEAD = "| engine | layer | passed | acceptable | failed | left out | worst digits | first failure |"


def reports() -> Iterator[tuple[str, LayerReport, dict[str, str]]]:
    """Every engine on every layer that it has an answer to."""
    for adapter in (pinocchio_adapter, coal_adapter):
        for layer, answer in adapter.LAYERS.items():
            yield adapter.NAME, *engine_report(layer, adapter.NAME, answer)
    for solver in qpsolvers_adapter.NAMES:
        name = qpsolvers_adapter.version_of(solver)
        yield name, *engine_report("qp", name, qpsolvers_adapter.answered_by(solver))
    yield mujoco_adapter.NAME, *mujoco_adapter.report()


def row(engine: str, report: LayerReport) -> str:
    """One line of the table."""
    counts = [report.count(v) for v in ("passed", "acceptable", "failed", "missing")]
    worst = f"{report.worst.digits:.1f}" if report.worst else "-"
    first = next((f"`{v.id}`" for v in report.verdicts if v.verdict == "failed"), "-")
    cells = [engine, report.layer, *map(str, counts), worst, first]
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Write the table and the findings."""
    lines = [HEAD, "|" + "---|" * 8]
    for engine, report, left_out in reports():
        print(row(engine, report), file=sys.stderr, flush=True)
        for verdict in report.verdicts:
            if verdict.verdict == "failed":
                print(f"    {verdict.id}: {verdict.reason}", file=sys.stderr)
        for reason in sorted(set(left_out.values())):
            print(f"    left out: {reason}", file=sys.stderr)
        lines.append(row(engine, report))
    findings = (HERE / "findings.md").read_text()
    (HERE / "results.md").write_text(findings.replace("TABLE", "\n".join(lines)))


if __name__ == "__main__":
    main()
