"""What ``compare`` says of whole runs of programs with a mistake that no rule was written for.

Run ``python -m validation.make.port_runs --out FILE`` (half an hour). Of the mutants of
``port_mutants`` that are kept apart 25 are drawn, by a hash of their names. Each takes 30 steps of
the scenes, one after the other, until ``compare`` sees a wrong step. What it says is held against
the place that was changed: the layer against the first that fails in ``vectors check``, a classic
mistake against ``validation/ports/causes.toml``.
"""

import json
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.lab.oracle.comparison import Comparison, comparison_of_run
from quasistatic_ref.lab.oracle.run_table import OtherRun
from quasistatic_ref.lab.oracle.scene_case import states_by
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from validation.make.port_mutants import (
    EACH,
    Port,
    Program,
    Question,
    Trial,
    causes,
    part_of,
    replies,
    trial_of,
)
from validation.tools.scripts import script_options, show_page

SCENES = ("two_finger_pinch", "block_push", "door", "arm_push", "sphere_spin")
STEPS = 30
DRAWN = {"go": 13, "cpp": 12}
"""Mutants of each port."""
PARTS = 6
"""Every sixth change is drawn from; of an odd part, so that it is kept apart."""

LAYERS = ("right", "among others", "wrong")
CAUSES = {
    "right": "a classic mistake, right",
    "wrong": "a classic mistake, wrong",
    "line": "lines of the plain program",
    "none": "none",
}


class RunsOutcome(NamedTuple):
    """What became of a mutant's runs.

    Parameters
    ----------
    outcome : str
        ``same``: each step as the reference takes it; ``ends``: no step at all; ``wrong``.
    layer, cause : str
        Of ``LAYERS`` and ``CAUSES``; empty if there is no wrong step.
    """

    outcome: str
    layer: str = ""
    cause: str = ""


def run_of(program: Program, scenario: Scenario) -> OtherRun | None:
    """The run of a scene by a program, as far as it goes; None if it takes no step."""
    q = [scenario.system.q_start]

    def answer(case: Json) -> Json:
        line = replies(program, [Question("step/run", "step", case, {})]).get("step/run", "{}")
        found = json.loads(line).get("output", {})
        q.append(scenario.system.normalised(np.array(found["q_next"], dtype=np.float64)))
        return found

    with suppress(QuasistaticError, KeyError, TypeError, ValueError):  # it ends, or q is none
        states_by(scenario, answer, STEPS)
    return OtherRun(0, np.array(q), 0.0) if len(q) > 1 else None


def runs_outcome(trial: Trial, program: Program) -> RunsOutcome:
    """What `compare` says of the runs of a mutant that has been checked."""
    runs = 0
    for name in SCENES:
        scenario = load_scenario(name, steps=STEPS)
        run = run_of(program, scenario)
        if run is None:
            continue
        runs += 1
        found = comparison_of_run(scenario, run)
        if found.first is not None:
            return RunsOutcome("wrong", _layer(trial, found), _cause(trial, found))
    return RunsOutcome("same" if runs else "ends")


def _layer(trial: Trial, found: Comparison) -> str:
    layers = {layer.partition(" ")[0] for layer in found.layers}
    if trial.check.layer not in layers:
        return "wrong"
    return "right" if len(layers) == 1 else "among others"


def _cause(trial: Trial, found: Comparison) -> str:
    names = [cause.name for cause in found.causes if cause.name]
    if not names:
        return "line" if found.causes else "none"
    return "right" if any(causes()[n].search(trial.where) for n in names) else "wrong"


HEAD = f"""# Whole runs of programs with a mistake

Made by `python -m validation.make.port_runs`. Of the [mutants of the ports](port_mutants.md) that
are kept apart {sum(DRAWN.values())} are drawn. Each takes the first {STEPS} steps of these scenes,
{", ".join(SCENES)},
until `quasistatic-ref compare` sees a wrong step. The layer is right if it is the first that fails
in `vectors check`; a classic mistake, if it is made in the place that was changed. Lines are those
of the plain program with which it would end so, too.
"""


def page(found: Sequence[RunsOutcome]) -> Iterator[str]:
    """The committed page."""
    yield HEAD
    outcomes = Counter(one.outcome for one in found)
    yield f"Of {len(found)} mutants {outcomes['wrong']} are found; {outcomes['same']} take each"
    yield f"step as the reference does, and {outcomes['ends']} none. What a mistake is about has to"
    yield "be in the scene, and to move something."
    yield ""
    count = Counter((one.cause, one.layer) for one in found)
    rows = [(words, *(count[cause, layer] for layer in LAYERS)) for cause, words in CAUSES.items()]
    rows.append(("all", *(sum(row[1 + i] for row in rows) for i in range(len(LAYERS)))))
    yield from markdown_table(("cause", *(f"layer {layer}" for layer in LAYERS)), rows)


def main() -> int:
    """Draw, run and compare; write the page."""
    options = script_options(__doc__, out=Path)
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for name, count in DRAWN.items():
            port = Port(name, Path(folder))
            before = len(found)
            for change, program in port.mutants(2 * EACH, lambda c: part_of(c.name, PARTS) == 1):
                trial = trial_of(port, change, program, cases=0)
                if program is not None and trial.outcome == "other":
                    found.append(runs_outcome(trial, program))
                    print(change.name, *found[-1], sep=", ", file=sys.stderr, flush=True)
                if len(found) == before + count:
                    break
    show_page("\n".join(page(found)), options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
