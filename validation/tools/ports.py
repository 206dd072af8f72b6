"""The port in Go, ``validation/ports/go``: built, checked and challenged.

Run ``python -m validation.tools.ports FOLDER`` to build it there, to check what it answers to the
vectors and to challenge it with some new cases. Exit status 1 if anything is wrong.
"""

import subprocess
import sys
from pathlib import Path

from quasistatic_ref.lab.vectors.challenge.program import Program
from quasistatic_ref.lab.vectors.challenge.run import challenge
from quasistatic_ref.lab.vectors.check.folder import check_answers
from quasistatic_ref.lab.vectors.check.verdict import UNSUPPORTED
from quasistatic_ref.lab.vectors.layers import LAYERS
from validation.tools.scripts import ROOT

PORT = ROOT / "validation" / "ports" / "go"
VECTORS = ROOT / "validation" / "vectors"
CASES = 88
"""That it is challenged with."""
UNSUPPORTED_CASES = {"distance": 177, "qp": 12, "wrench": 5}
"""Of curved shapes and second-order cones, which it does not do; all others it has to answer."""


def main() -> int:
    """Build, check and challenge it."""
    folder = Path(sys.argv[1]).resolve()
    answers = folder / "answers"
    answers.mkdir(parents=True)
    program = folder / "port_go"
    subprocess.run(["go", "build", "-o", program, "."], cwd=PORT, check=True)
    subprocess.run([program, VECTORS, answers], check=True)
    report = check_answers(answers, VECTORS, LAYERS[:8])
    silent = {one.layer: n for one in report.layers if (n := one.count(UNSUPPORTED))}
    outcome = challenge(Program(str(program)), cases=CASES)
    print(*report.sentences, *(finding.title for finding in outcome.findings), sep="\n")
    return int(not report.ok or silent != UNSUPPORTED_CASES or bool(outcome.findings))


if __name__ == "__main__":
    sys.exit(main())
