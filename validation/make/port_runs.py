"""What ``compare`` says of whole runs of programs with a mistake that no rule was written for.

Run ``python -m validation.make.port_runs --records FILE --out FILE`` (half an hour; name a port for
it alone). Of the mutants of ``port_mutants`` that are kept apart, and that the committed vectors
find wrong, 25 are drawn by a hash of their names. Each takes the steps of all scenes in
``validation/scenes``, which ``compare`` is given together. What it says is held against what the
mutant is: the layer against the first that fails in ``vectors check``; the formulas against the
function that was changed, as in ``port_mutants``. The records have what is known of each, and a
second run goes on from there.
"""

import json
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.oracle.comparison import (
    DIGITS,
    comparison_of_run,
    diagnosis_of_runs,
)
from quasistatic_ref.lab.oracle.run_table import OtherRun
from quasistatic_ref.lab.oracle.scene_case import states_by
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.vectors.check.verdict import FAILED
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.scenario.scenario import Scenario
from validation.make.planted_runs import SCENES, scene
from validation.make.port_mutants import EACH, Port, part_of, verdict
from validation.tools.port_programs import Program, committed_questions, replies, started
from validation.tools.scripts import script_options, show_page

DRAWN = {"go": 13, "cpp": 12}
"""Mutants of each port."""
PARTS = 6
"""Every sixth change is drawn from; of an odd part, so that it is kept apart."""
APART = 1
LAYERS = ("right", "wrong", "open")
VERDICTS = ("right", "wrong", "silent")


class RunsOutcome(NamedTuple):
    """What became of a mutant's runs.

    Parameters
    ----------
    outcome : str
        ``same``: each step as the reference takes it; ``ends``: no step at all; ``wrong``.
    fails : str
        The first layer that fails in ``vectors check``.
    layer, cause : str
        Of ``LAYERS`` and ``VERDICTS``; empty if there is no wrong step.
    """

    outcome: str
    fails: str
    layer: str = ""
    cause: str = ""


@cache
def right_replies(port: Port, layer: str) -> dict[str, str]:
    """What the port answers without a mistake."""
    return replies(port.program, port.within(committed_questions(layer)))


def first_failure(port: Port, program: Program) -> str:
    """The first layer in which ``vectors check`` finds a mutant wrong; "" if none."""
    for layer in port.scope.layers:
        right = right_replies(port, layer)
        asked = port.within(committed_questions(layer))
        given = replies(program, asked)
        for q in asked:
            line = given.get(q.id, "")
            if line == right[q.id]:
                continue
            if '"output"' not in line or port.judged(q, line).verdict.verdict == FAILED:
                return layer
    return ""


def run_of(program: Program, scenario: Scenario) -> OtherRun:
    """The run of a scene by a program, as far as it goes."""
    q = [scenario.system.q_start]
    with started(program) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdout.readline()  # what the program is

        def answer(case: Json) -> Json:
            asked = {"id": "run", "layer": "step", "input": case}
            print(json.dumps(asked), file=process.stdin, flush=True)
            found = json.loads(process.stdout.readline())["output"]
            q.append(scenario.system.normalised(np.array(found["q_next"], dtype=np.float64)))
            return found

        with suppress(QuasistaticError, KeyError, TypeError, ValueError, OSError):  # it ends
            states_by(scenario, answer, scenario.steps)
        with suppress(OSError):
            process.stdin.close()
        process.kill()
    return OtherRun(0, np.array(q), 0.0)


@cache
def scenes_of(port: Port) -> tuple[str, ...]:
    """The scenes that a port takes steps of."""
    return tuple(name for name in SCENES if len(run_of(port.program, scene(name)).q) > 1)


def runs_outcome(port: Port, fails: str, where: str, program: Program) -> RunsOutcome:
    """What `compare` says of the runs of a mutant, of which a layer fails in ``vectors check``."""
    runs = [(scene(name), run_of(program, scene(name))) for name in scenes_of(port)]
    found = [comparison_of_run(scenario, run) for scenario, run in runs]
    if not any(one.is_wrong for one in found):
        return RunsOutcome("same", fails)
    ends = all(len(run.q) == 1 for _, run in runs)
    if (said := diagnosis_of_runs(found)) is None:
        return RunsOutcome("ends", fails) if ends else RunsOutcome("wrong", fails, "open", "silent")
    way = {"kind": "wrong", "names": [], "formulas": said.formulas}
    cause = verdict({"name": port.name, "where": where, "run": way}, "run")
    outcome = "ends" if ends else "wrong"
    return RunsOutcome(outcome, fails, "right" if said.layer == fails else "wrong", cause)


HEAD = f"""# Whole runs of programs with a mistake

Made by `python -m validation.make.port_runs`: [mutants of the ports](port_mutants.md) are drawn
from those that are kept apart and that the committed vectors find wrong. Each takes the steps of
[the scenes for comparisons](../scenes/README.md) that its port can read, which `quasistatic-ref
compare` is given together; a step of fewer than {DIGITS:g} digits is wrong. The layer that is said
is right if it is the first that fails in `vectors check`; the one or two formulas are right as in
[the table of mutants](port_mutants.md). No rule was written while looking at them. Such 25 were
counted with three rules. The first named no formula, and had the layer right for 14 of 18; the
second always named some, and had the layer right for 12 and the formulas for 11; this one says
nothing where more than two formulas are as like.
"""


def page(found: Sequence[RunsOutcome]) -> Iterator[str]:
    """The committed page."""
    yield HEAD
    outcomes = Counter(one.outcome for one in found)
    yield f"Of {len(found)} mutants {outcomes['wrong']} take a step that compare finds wrong;"
    yield f"{outcomes['same']} take each as the reference does,"
    yield f"{outcomes['ends']} end in every scene before a step."
    still = Counter(one.fails for one in found if one.outcome == "same")
    if still:
        words = ", ".join(f"{layer} ({count})" for layer, count in still.most_common())
        yield f"Those that move nothing fail `vectors check` in: {words}."
    yield ""
    count = Counter((one.cause, one.layer) for one in found)
    rows = [(cause, *(count[cause, layer] for layer in LAYERS)) for cause in VERDICTS]
    rows.append(("all", *(sum(row[1 + i] for row in rows) for i in range(len(LAYERS)))))
    yield from markdown_table(("said", *(f"layer {layer}" for layer in LAYERS)), rows)


def main() -> int:
    """Draw, run and compare; write the page."""
    options = script_options(__doc__, ("go", "cpp"), out=Path, records=Path)
    done: dict[str, RunsOutcome | None] = {}
    if options.records and options.records.exists():
        for name, values in map(json.loads, options.records.read_text("utf-8").splitlines()):
            done[name] = RunsOutcome(*values) if values else None
    with tempfile.TemporaryDirectory() as folder:
        for name in options.names or DRAWN:
            port = Port(name, Path(folder))
            mutants = port.mutants(2 * EACH, lambda change: part_of(change.name, PARTS) == APART)
            kept = 0
            for change, program in mutants:
                if change.name not in done:
                    fails = first_failure(port, program) if program is not None else ""
                    where = f"{change.place}: {change.old.strip()}"
                    wrong = fails and program is not None
                    one = runs_outcome(port, fails, where, program) if wrong else None
                    done[change.name] = one
                    print(one or "not wrong", file=sys.stderr, flush=True)
                    if options.records:
                        with options.records.open("a") as file:
                            file.write(json.dumps([change.name, one]) + "\n")
                kept += done[change.name] is not None
                if kept == DRAWN[name]:
                    break
    show_page("\n".join(page([one for one in done.values() if one is not None])), options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
