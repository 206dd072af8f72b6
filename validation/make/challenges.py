"""The plain program and the ports challenged, in all that they answer.

Run ``python -m validation.make.challenges --log FILE --out FILE`` (some hours on two cores; name a
program to challenge only that one). A challenge goes in pieces of 2,000 cases, with the seeds 1, 2,
3, ..., until 20,000 answers of the plain program and 10,000 of each port were judged: what one says
it does not support is no answer. Each piece is a line of the log, from which the same command goes
on; what is found is kept next to it.

Exit status 1 if anything was found.
"""

import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping
from operator import itemgetter
from pathlib import Path

from quasistatic_ref.lab.log import Log, Record
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.check.scope import WHOLE, scope_read
from quasistatic_ref.lab.vectors.layers import LAYERS
from validation.tools.ports import PORTS, compiler_errors
from validation.tools.scripts import script_options, show_page

PLAIN = f"{sys.executable} -m quasistatic_ref.lab.program"
ANSWERS = {"numpy": 20_000, "go": 10_000, "cpp": 10_000}
"""That are judged of each program."""
PIECE = 2_000
"""Cases of a seed."""


def piece(runner: str, command: str, seed: int, jobs: int, kept: Path | None) -> Record:
    """What one seed came to; findings are written to a folder, if there is one."""
    scope = scope_read(PORTS / runner / "scope.toml") if (PORTS / runner).exists() else WHOLE
    program = Program(command, timeout=60.0)
    found = challenge(program, cases=PIECE, seed=seed, jobs=jobs, scope=scope)
    for finding in found.findings if kept else ():
        finding.write_folder(kept / f"{runner}_{seed}", command)
    verdicts = {layer: {} for layer in LAYERS if found.sent[layer]}
    for (layer, verdict), count in sorted(found.verdicts.items()):
        verdicts[layer][verdict] = count
    titles = [finding.title for finding in found.findings]
    return {"runner": runner, "seed": seed, "verdicts": verdicts, "findings": titles,
            "remarks": found.remarks}  # fmt: skip


def verdict_counts(pieces: list[Record]) -> dict[str, Counter[str]]:
    """Verdicts by layer of all pieces."""
    found = {layer: Counter() for layer in LAYERS}
    for one in pieces:
        for layer, verdicts in one["verdicts"].items():
            found[layer].update(verdicts)
    return {layer: verdicts for layer, verdicts in found.items() if verdicts}


def judged_count(pieces: list[Record]) -> int:
    """How many answers were judged."""
    verdicts = verdict_counts(pieces).values()
    return sum(one.total() - one["unsupported"] for one in verdicts)


def challenge_pieces(runner: str, log: Log, jobs: int, kept: Path | None) -> list[Record]:
    """The pieces of a program."""
    pieces = []
    with tempfile.TemporaryDirectory() as folder:
        command = PLAIN
        if (PORTS / runner).exists():
            command = str(Path(folder) / runner)
            if said := compiler_errors(runner, Path(command)):
                raise SystemExit(said)
        while judged_count(pieces) < ANSWERS[runner]:
            seed = len(pieces) + 1
            if (runner, seed) not in log.found:
                log.add(piece(runner, command, seed, jobs, kept))
            pieces.append(log.found[runner, seed])
    return pieces


HEAD = f"""# Three programs challenged

Made by `python -m validation.make.challenges`: `quasistatic-ref vectors challenge` asks the
plain NumPy program (numpy) and [the ports](../ports/README.md) in Go (go) and C++ (cpp) new cases
of their layers, and of the ports' scopes, {PIECE:,} of each seed from 1 on, until
{ANSWERS["numpy"]:,} answers of the plain program and {ANSWERS["go"]:,} of each port are judged.
*Not supported* is what one declines.
"""
KINDS = ("passed", "acceptable", "failed", "unsupported")


def page(found: Mapping[str, list[Record]]) -> Iterator[str]:
    """The committed page."""
    yield HEAD
    names = (
        "program",
        "layer",
        "cases",
        "passed",
        "acceptable",
        "failed",
        "not supported",
        "other",
    )
    rows = []
    for runner, pieces in found.items():
        for layer, verdicts in verdict_counts(pieces).items():
            counts = [verdicts[kind] for kind in KINDS]
            cells = [verdicts.total(), *counts, verdicts.total() - sum(counts)]
            rows.append((runner, layer, *(f"{n:,}" for n in cells)))
    yield from markdown_table(names, rows)
    yield ""
    for runner, pieces in found.items():
        findings = [title for one in pieces for title in one["findings"]]
        said = f"{runner}: seeds 1 to {len(pieces)}, {judged_count(pieces):,} answers judged"
        yield f"{said}, {len(findings) or 'no'} finding{'s' * (len(findings) != 1)}."
        yield from (f"- {title}" for title in findings)
        remarks = dict.fromkeys(remark for one in pieces for remark in one["remarks"])
        yield from (f"- {remark}" for remark in remarks)


def main() -> int:
    """Challenge all, or those that are named; write the page."""
    options = script_options(__doc__, ANSWERS, log=Path, out=Path, jobs=1)
    log = Log(options.log, itemgetter("runner", "seed"))
    kept = options.log and options.log.parent
    names = options.names or ANSWERS
    found = {name: challenge_pieces(name, log, options.jobs, kept) for name in names}
    show_page("\n".join(page(found)), options.out)
    return int(any(one["findings"] for pieces in found.values() for one in pieces))


if __name__ == "__main__":
    sys.exit(main())
