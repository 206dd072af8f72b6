"""Answers attacked where they are made and written: ``python -m validation.make.attacks``.

- *Exact answers*: of ordinary steps, and of steps at all scales. The optimum on the working set of
  a file is proved and rounded by fractions, a proof of infeasibility checked by fractions;
  ``verify.js`` has to verify every field.
- *Bounds* of backends' own answers to ordinary steps, to steps of subnormal, tiny and huge numbers
  and to steps of nearly singular matrices: what a file claims is compared with the optimum by
  fractions, and `verify` of the package has to verify it.
- *Nearly singular matrices*: exact pivots say which are positive definite; reading a step and
  ``verify.js`` have to say the same. What is accepted has to end in an answer or in a sentence.

Nothing that is expected comes from the package: see :mod:`tests.oracles.solution_truth`. Its exact
method only names working sets, whose optimality is proved here. Prints a table, and exits with
status 1 if anything is wrong. ``--count`` is that of exact answers of each family, 500 unless it is
said, with the others in proportion. All counts take some 15 minutes of one core.
"""

import json
import sys
from collections import Counter
from fractions import Fraction
from itertools import cycle, islice, pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from tqdm import tqdm

from quasistatic_ref import (
    InputError,
    QuasistaticError,
    StepData,
    StepInfeasible,
    solve_step,
    step_read,
)
from quasistatic_ref.cli.solution_files import infeasible_text, solution_text
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.solve.backends import NONE
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.files import step_text
from tests.oracles.attacked_steps import FAMILIES, singular, steps
from tests.oracles.random_steps import any_step
from tests.oracles.rational_kkt import exact, proved_optimum
from tests.oracles.solution_truth import (
    Judge,
    combinations,
    nearest_float,
    program,
    proof,
    wrenches,
)
from validation.tools.check_verifier import verdicts
from validation.tools.scripts import script_options, show_page
from validation.tools.verifier_files import Case, verify_refusal

Json = Any
BATCH = 50
"""Cases that ``verify.js`` is asked about at once."""
BACKENDS = "daqp", "clarabel", "osqp", "piqp", "quadprog"
SHARE = Fraction(1e-14)
"""Of its diagonal entry, what a pivot has to be above."""
SOLUTION = json.dumps({
    "format": "quasistatic-ref/solution", "version": 2, "status": "infeasible", "cone": "pyramid",
    "step_sha256": "", "farkas": [],
})  # fmt: skip
"""Of no step: its reader looks at the step first."""


class Attack:
    """What came of the cases of one family, and those that went wrong.

    Parameters
    ----------
    name : str
        Of the family.
    folder : Path
        For files.
    """

    def __init__(self, name: str, folder: str) -> None:
        self.name = name
        self.folder = Path(folder)
        self.counts = Counter()
        self.wrong = []
        self.cases = []

    def add(self, outcome: str, holds: bool = True, note: str = "") -> None:
        """Count a case, and keep what is wrong with it."""
        self.counts[outcome] += 1
        if not holds:
            self.counts["wrong"] += 1
            self.wrong.append(f"{self.name}: {outcome}: {note}"[:500])

    def file(self, step: StepData, backend: str, certify: str) -> str | None:
        """The solution file of a step; None, and counted, where there is an error in its place."""
        try:
            solver = solver_for(step, backend, fast=backend != NONE)
            return solution_text(solve_step(step, solver, certify=certify))
        except StepInfeasible as said:
            return infeasible_text(step, said.farkas.exact)
        except QuasistaticError as said:
            self.add(f"{certify}: {type(said).__name__}")
        except Exception as error:  # whatever it is: a traceback
            self.add("a traceback", False, f"{error!r} {step_text(step)}")
        return None

    def ask(self, step: str, solution: str, begins: str = "every field is proved") -> None:
        """Keep two texts for ``verify.js``, whose reason has to begin so."""
        self.cases.append(Case(self.name, step, solution, None, reason=begins))

    def by_javascript(self) -> None:
        """Ask ``verify.js`` about all texts that were kept."""
        for case, said in zip(self.cases, verdicts(self.cases), strict=True):
            agrees = said["reason"].startswith(case.reason)
            self.add("as verify.js says", agrees, f"{said} {case.step}")


def positive_definite(S: np.ndarray) -> bool:
    """Whether all pivots are above their share of the diagonal, in fractions."""
    rest = exact(S)
    diagonal = [row[i] for i, row in enumerate(rest)]
    for k, entry in enumerate(diagonal):
        pivot = rest[k]
        if pivot[k] <= 0 or pivot[k] <= SHARE * entry:
            return False
        for i in range(k + 1, len(rest)):
            part = rest[i][k] / pivot[k]
            rest[i] = [v - part * w for v, w in zip(rest[i], pivot, strict=True)]
    return True


def right_file(step: StepData, record: Json) -> Json:
    """What of an exact solution file fractions decide, from the working set that it names."""
    of = program(step)
    sizes = [len(rows) for rows in combinations(step)]
    starts = np.cumsum([0, *sizes]).tolist()
    working = [starts[j] + i for j, i in record["certificate"]["active"]]
    x, lam_w, slack = proved_optimum(of, working)
    lam = [0.0] * len(of[3])
    for i, value in zip(working, lam_w, strict=True):
        lam[i] = nearest_float(value)
    by_contact = [lam[a:b] for a, b in pairwise(starts)]
    known = {"smallest_active_multiplier": min(map(nearest_float, lam_w), default=None)}
    if record["certificate"]["differentiable"]:
        open_ = [nearest_float(s) for s in slack if s]
        known["smallest_inactive_slack"] = min(open_, default=None)
    return record | {
        "delta_q": [*map(nearest_float, x)],
        "lam": by_contact,
        "lam_extra": lam[starts[-1] :],
        "wrench": wrenches(step, by_contact),
        "certificate": record["certificate"] | known | {"error_bound": 0.0},
    }


def exact_answers(attack: Attack, family: str, number: int, first: int = 0) -> None:
    """Exact answers and proofs that there is none, until there are so many."""
    for step in islice(steps(family, first), 50 * number):
        if attack.counts["optimal"] + attack.counts["infeasible"] == number:
            break
        text = step_text(step)
        file = attack.file(step, NONE, "full")
        if file is None:
            continue
        record = json.loads(file)
        if record["status"] == "infeasible":
            holds = proof(step, exact(record["farkas"]))
        else:
            try:
                holds = json.dumps(right_file(step, record)) == json.dumps(record)
            except ArithmeticError:
                holds = False
        holds = holds and verify_refusal(attack.folder, text, file) is None
        attack.add(record["status"], holds, text)
        attack.ask(text, file)


def bounds(attack: Attack, family: str, number: int, first: int = 0) -> None:
    """Bounds of backends' own answers, until there are so many."""
    tried = zip(cycle(BACKENDS), steps(family, first), strict=False)
    for backend, step in islice(tried, 50 * number):
        if attack.counts["bounded"] == number:
            break
        text = step_text(step)
        file = attack.file(step, backend, "residual")
        if file is None:
            continue
        record = json.loads(file)
        bound = record["certificate"]["error_bound"]
        if bound is None:
            attack.add("no useful bound")
            continue
        try:
            judged = Judge(step, record)
            square = judged.off(record) + 2 * judged.gap(record) / judged.free
            holds = 0 <= bound <= 1 and square <= Fraction(bound) ** 2
        except ArithmeticError:  # without an optimum, or without a load
            holds = False
        holds = holds and record["wrench"] == wrenches(step, record["lam"])
        attack.add("bounded", holds and verify_refusal(attack.folder, text, file) is None, text)


def matrices(attack: Attack, key: str, number: int, first: int = 0) -> None:
    """Nearly singular matrices, through both checkers and all that is made of a step."""
    for seed in range(first, first + number):
        rng = np.random.default_rng(seed)
        n = int(rng.integers(1, 8))
        n_c = int(rng.integers(0, 4))
        sizes = (n, 0) if key == "K_q" else (0, n)
        S = singular(rng, n)
        step = any_step(rng, *sizes, n_c)
        text = json.dumps(json.loads(step_text(step)) | {key: S.tolist()})
        path = attack.folder / "step.json"
        path.write_text(text)
        try:
            read = step_read(path)
        except InputError as error:
            holds = not positive_definite(S) and "must be positive definite" in str(error)
            attack.add("refused", holds, f"{error} {text}")
            attack.ask(text, SOLUTION, f"{key} is not positive definite")
            continue
        attack.add("accepted", positive_definite(S), text)
        for certify in ("full", "residual", "off"):
            backend = NONE if seed % 2 and certify == "full" else BACKENDS[seed % 5]
            file = attack.file(read, backend, certify)
            if file is None:
                continue
            claims = certify == "full" or (certify == "residual" and ": null" not in file)
            said = verify_refusal(attack.folder, text, file) if claims else None
            outcome = "verified" if claims else "nothing claimed"
            attack.add(f"{certify}: {outcome}", said is None, f"{said} {text}")
            if certify == "full":
                attack.ask(step_text(read), file)


ATTACKS = {
    "exact answers": exact_answers,
    "bounds": bounds,
    "nearly singular": matrices,
}


def attack_counts(kind: str, family: str, number: int) -> tuple[Counter[str], list[str]]:
    """What came of so many cases of a family, and those that went wrong."""
    counts = Counter()
    wrong = []
    for k, start in enumerate(range(0, number, BATCH)):
        with TemporaryDirectory() as folder:
            attack = Attack(f"{kind}, {family}", folder)
            first = 100 * BATCH * k  # not each seed is a case
            ATTACKS[kind](attack, family, min(BATCH, number - start), first)
            attack.by_javascript()
        counts += attack.counts
        wrong += attack.wrong
    return counts, wrong


def main() -> int:
    """Print the table; exit status 1 if anything is wrong."""
    options = script_options(__doc__, count=500, out=Path)
    count = options.count
    families = [("bounds", family, 2 * count) for family in FAMILIES]
    families += [("exact answers", family, count) for family in FAMILIES]
    families += [("nearly singular", key, 5 * count // 2) for key in ("K_q", "M_u")]
    rows = []
    wrong = []
    for kind, family, number in tqdm(sorted(families), "families"):
        counts, own = attack_counts(kind, family, number)
        rows += [(f"{kind}, {family}", what, f"{n:,}") for what, n in sorted(counts.items())]
        wrong += own
    lines = markdown_table(("what", "what came of it", "cases"), rows, left=2)
    lines += ["", f"{len(wrong)} cases are wrong."]
    show_page(HEAD + "\n".join(lines), options.out)
    print(*wrong[:20], sep="\n")
    return int(bool(wrong))


HEAD = """# Answers, bounds and matrices, attacked

Made by `python -m validation.make.attacks`, whose first lines say what is asked.

"""

if __name__ == "__main__":
    sys.exit(main())
