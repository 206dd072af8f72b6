"""Both runners challenged with 20,000 cases each, in all layers that they answer.

Run ``python -m validation.make.challenges --work FOLDER --out FILE`` (some hours on two cores; name
a runner to challenge only that one). A challenge goes in pieces of 2,000 cases, with the seeds 1,
2, 3, ..., until 20,000 answers were judged: what a runner says it does not support is no answer.
Each piece is kept in the folder, and one that is there is not made again, so that a run can be
resumed.

Exit status 1 if anything was found.
"""

import argparse
import json
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import LAYERS
from validation.make.planted_bugs import COMMANDS

ANSWERS = 20_000
"""That are judged of each runner."""
PIECE = 2_000
"""Cases of a seed."""


def piece(runner: str, seed: int, work: Path, jobs: int) -> Json:
    """What one seed came to: made, or read again."""
    path = work / f"{runner}_{seed}.json"
    if not path.exists():
        program = Program(COMMANDS[runner], timeout=60.0)
        found = challenge(program, cases=PIECE, seed=seed, jobs=jobs)
        for finding in found.findings:
            finding.written(work / f"{runner}_{seed}", COMMANDS[runner])
        verdicts = {layer: {} for layer in LAYERS if found.sent[layer]}
        for (layer, verdict), count in sorted(found.verdicts.items()):
            verdicts[layer][verdict] = count
        record = {
            "verdicts": verdicts,
            "findings": [finding.title for finding in found.findings],
            "remarks": found.remarks,
        }
        text_written(path, json.dumps(record, indent=1) + "\n")
        print(f"{runner}, seed {seed}: {found.seconds:.0f} s", file=sys.stderr, flush=True)
    return json.loads(path.read_text(encoding="utf-8"))


def counted(pieces: list[Json]) -> dict[str, Counter[str]]:
    """Verdicts by layer of all pieces."""
    found = {layer: Counter() for layer in LAYERS}
    for one in pieces:
        for layer, verdicts in one["verdicts"].items():
            found[layer].update(verdicts)
    return {layer: verdicts for layer, verdicts in found.items() if verdicts}


def judged(pieces: list[Json]) -> int:
    """How many answers were judged."""
    verdicts = counted(pieces).values()
    return sum(one.total() - one["unsupported"] for one in verdicts)


def challenged(runner: str, work: Path, jobs: int) -> list[Json]:
    """The pieces of a runner."""
    pieces: list[Json] = []
    while judged(pieces) < ANSWERS:
        pieces.append(piece(runner, len(pieces) + 1, work, jobs))
    return pieces


HEAD = f"""# Both programs challenged

Made by `python -m validation.make.challenges`: `quasistatic-ref vectors challenge` asks the
plain NumPy program (numpy) and the runner of `validation/programs/runners/` (javascript) new cases
in all layers that they answer, {PIECE:,} of each seed from 1 on, until {ANSWERS:,} answers of each
are judged. *Not supported* is what one declines: the JavaScript runner has distances of simple
shapes alone, within its steps.
"""
KINDS = ("passed", "acceptable", "failed", "unsupported")


def page(found: dict[str, list[Json]]) -> Iterator[str]:
    """The committed page."""
    yield HEAD
    names = ("runner", "layer", "cases", "passed", "acceptable", "failed", "not supported", "other")
    rows = []
    for runner, pieces in found.items():
        for layer, verdicts in counted(pieces).items():
            counts = [verdicts[kind] for kind in KINDS]
            cells = [verdicts.total(), *counts, verdicts.total() - sum(counts)]
            rows.append((runner, layer, *(f"{n:,}" for n in cells)))
    yield from markdown_table(names, rows)
    yield ""
    for runner, pieces in found.items():
        findings = [title for one in pieces for title in one["findings"]]
        said = f"{runner}: seeds 1 to {len(pieces)}, {judged(pieces):,} answers judged"
        yield f"{said}, {len(findings) or 'no'} finding{'s' * (len(findings) != 1)}."
        yield from (f"- {title}" for title in findings)
        remarks = dict.fromkeys(remark for one in pieces for remark in one["remarks"])
        yield from (f"- {remark}" for remark in remarks)


def main() -> int:
    """Challenge both, or those that are named; write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runners", nargs="*", choices=[[], *COMMANDS], help="all by default")
    parser.add_argument("--work", type=Path, metavar="FOLDER", help="where pieces are kept")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write the page here")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        work = options.work or Path(temporary)
        found = {name: challenged(name, work, options.jobs) for name in options.runners or COMMANDS}
    text = "\n".join(page(found)) + "\n"
    print(text) if options.out is None else text_written(options.out, text)
    return int(any(one["findings"] for pieces in found.values() for one in pieces))


if __name__ == "__main__":
    sys.exit(main())
