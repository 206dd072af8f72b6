"""``validate [NAME...]``: measure the claims about the model, or predict measured pushes."""

import argparse
import sys

from quasistatic_ref.cli import options as shared
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.claims.claim import FAILS, HOLDS, NOT_RUN, ClaimResult, claim_result
from quasistatic_ref.lab.claims.registry import BY_NAME, CLAIMS
from quasistatic_ref.lab.claims.report import (
    chapter,
    chapters_of,
    claims_page,
    finding_record,
    summary,
)
from quasistatic_ref.lab.commands import reality
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.text.content import text_written, writable_folder

IN = {
    "daqp": "daqp",
    "mujoco": "'quasistatic-ref[engines]'",
}
"""What an engine of a claim comes in."""
HELP = "claim to test (default: all), or 'reality', which predicts measured pushes"


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the options of this command."""
    parser.add_argument("names", nargs="*", metavar="NAME", help=HELP)
    shared.add(parser, "--out", default="results")
    shared.add(parser, "--json")
    reality.add_options(parser)


def run(options: argparse.Namespace) -> int:
    """Measure claims, print a table and write claims.md; exit status 1 if a claim fails.

    If claims are named, a claims.md that is there keeps its chapters of all other claims.

    Raises
    ------
    InputError
        If a name is unknown, or an option is not for claims.
    """
    if options.names == [reality.NAME]:
        return reality.run(options)
    reality.refuse(options)
    for name in options.names:
        if name not in BY_NAME:
            raise InputError(f"is not a claim{suggestion(name, BY_NAME)}", field="NAME", value=name)
    writable_folder(options.out)
    chosen = options.names or list(BY_NAME)
    findings: dict[str, ClaimResult] = {}
    for k, name in enumerate(chosen, start=1):
        shared.progress_line(options, f"[{k}/{len(chosen)}] {name} ...", end=" ")
        findings[name] = claim_result(BY_NAME[name])
        took = f"({findings[name].seconds:.1f} s)"
        shared.progress_line(options, f"{findings[name].verdict} {took}")
    file = options.out / "claims.md"
    before = file.read_text("utf-8") if options.names and file.exists() else ""
    chapters = chapters_of(before) | {name: chapter(found) for name, found in findings.items()}
    sections = {
        title: [chapters[name] for name in claims if name in chapters]
        for title, claims in CLAIMS.items()
    }
    page = text_written(file, claims_page(sections))
    failed = [name for name, result in findings.items() if result.verdict == FAILS]
    if options.json:
        records = [finding_record(result) for result in findings.values()]
        shared.print_json({"claims": records, "failed": failed, "page": str(page)})
        return 1 if failed else 0
    rows: list[tuple[str, ...]] = [("claim", "verdict", "points", "worst error", "tolerance")]
    rows += [(name, *summary(result)) for name, result in findings.items()]
    shared.print_rows(rows)
    count = {v: sum(f.verdict == v for f in findings.values()) for v in (HOLDS, FAILS, NOT_RUN)}
    print(", ".join(f"{n} {verdict}" for verdict, n in count.items() if n))
    missing = {str(f.claim.engine) for f in findings.values() if f.verdict == NOT_RUN}
    for engine in sorted(missing):
        remedy = f"pip install {IN.get(engine, engine)}"
        print(f"quasistatic-ref: some claims need {engine}: {remedy}", file=sys.stderr)
    for name in failed:
        print(f"quasistatic-ref: {_why(findings[name])}", file=sys.stderr)
    print(f"wrote {page}")
    return 1 if failed else 0


def _why(result: ClaimResult) -> str:
    """One sentence on a claim that fails."""
    name = result.claim.name
    if result.trouble:
        return f"{name} could not be measured: {result.trouble}"
    bad = [c for c in finding_record(result)["comparisons"] if not c["holds"]]
    differences = "; ".join(f"{c['what']} is {c['measured']}, not {c['expected']}" for c in bad)
    return f"{name} fails: {differences}"
