"""Cases of the vectors for features of which a layer has few.

Run ``python -m validation.make.thin_cases --out FOLDER``: cases are drawn as for a challenge, and
kept if they have a feature (``lab/vectors/features.py``) of which the layer has fewer than five
cases. FOLDER gets the vectors with these behind the others, which keep their bits. A new version
is made of it by ``vectors generate`` and the hashes in ``versions.toml``.
"""

import json
import sys
from pathlib import Path

import numpy as np

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.vectors.challenge.fresh import HARD, MAKERS, PLAIN, record_of
from quasistatic_ref.lab.vectors.check.answers import Answers
from quasistatic_ref.lab.vectors.check.folder import answer_judged
from quasistatic_ref.lab.vectors.check.verdict import FAILED
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.features import FEW, counted, features
from quasistatic_ref.lab.vectors.files import Case, expected_read, expected_text, inputs_read, line
from quasistatic_ref.lab.vectors.generate import expected_record
from quasistatic_ref.lab.vectors.layers import LAYERS, layer
from validation.tools.scripts import ROOT, asked

VECTORS = ROOT / "validation" / "vectors"
DRAWS = 400
"""Of each layer."""
LONGEST = 6000
"""Characters of a case: a porter reads it."""
LEFT = ("distance", "qp", "derivative")
"""Layers whose cases were made for each feature."""


def drawn(name: str) -> list[Case]:
    """Cases of a layer for its thin features."""
    expected = expected_read(VECTORS, name)
    known = [(case.input, expected[case.id]["output"]) for case in inputs_read(VECTORS, name)]
    counts = counted(known)
    found: list[Case] = []
    for number in range(DRAWS):
        rng = np.random.default_rng([7, LAYERS.index(name), number])
        case = MAKERS[name](rng, HARD if number % 4 == 3 else PLAIN)
        if len(line(case)) > LONGEST or not _thin(case, {}, counts):
            continue
        record = record_of(name, case)
        if record is None:
            continue
        thin = _thin(case, record["output"], counts)
        if not thin or not _met(name, case):
            continue
        counts.update(features(case, record["output"]))
        words = f"drawn at random, for {', '.join(sorted(thin))}"
        found.append(Case(f"{name}/thin/{len(found)}", words, case))
        print(found[-1].id, words, flush=True)
    return found


def _met(name: str, case: Json) -> bool:
    """Whether float64 meets the tolerances of a case, as the package's own answer shows."""
    whole = Case(f"{name}/thin", "", case)
    record = expected_record(name, whole)
    own = layer(name).own(case)
    return answer_judged(name, whole, record, own, Answers(), None).verdict.verdict != FAILED


def _thin(case: Json, output: Json, counts: dict[str, int]) -> set[str]:
    """Features of a case of which there are few; of scenes not which shapes meet."""
    found = {one for one in features(case, output) if " on " not in one}
    return {one for one in found if counts[one] < FEW}


def appended(folder: Path, out: Path, name: str, cases: list[Case]) -> None:
    """Write a layer with further cases."""
    inputs = json.loads((folder / "inputs" / f"{name}.json").read_text("utf-8"))
    text = (folder / "inputs" / f"{name}.json").read_text("utf-8")
    new = [{"id": c.id, "provenance": c.provenance, "input": c.input} for c in cases]
    last = line(inputs["cases"][-1])
    text = text.replace(last, ",\n".join([last, *map(line, new)]))
    text_written(out / "inputs" / f"{name}.json", text)
    old = [*expected_read(folder, name).values()]
    records = [expected_record(name, case) for case in cases]
    text_written(out / "expected" / f"{name}.json", expected_text(name, [*old, *records]))


def main() -> int:
    """Draw for each layer, and write the folder."""
    options = asked(__doc__, [name for name in LAYERS if name not in LEFT], out=Path)
    for name in options.names or [name for name in LAYERS if name not in LEFT]:
        (options.out / "inputs").mkdir(parents=True, exist_ok=True)
        (options.out / "expected").mkdir(parents=True, exist_ok=True)
        appended(VECTORS, options.out, name, drawn(name))
    return 0


if __name__ == "__main__":
    sys.exit(main())
