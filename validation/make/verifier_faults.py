"""Faults planted in the second checker, each of which the sample of its files must notice.

``python -m validation.make.verifier_faults`` takes out each refusal of the checker in turn, and
changes one comparison, limit or rounding at a time; what is left judges the sample of
:mod:`validation.tools.check_verifier`, files with one fault first. Prints a table, and exits with
status 1 if a fault is not noticed.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from quasistatic_ref.formats.files import text_written
from validation.tools.check_verifier import VERIFIER, disagreement, verdicts
from validation.tools.verifier_files import Case, all_cases

CHANGES = (
    ("ahead < 0n ||", "ahead > 0n ||"),
    ('y.sign > 0), "a multiplier', 'y.sign >= 0), "a multiplier'),
    ("twice > bottom ||", "twice >= bottom ||"),
    ("floor & 1n)", "false)"),
    ("-1074", "-1022"),
    ("2n ** 53n", "2n ** 54n"),
    ("need(cert.multipliers_unique === unique &&", "need("),
    ("&& cert.differentiable === differentiable,", ","),
    ("[...R.map(() => 0n), 1n]", "[...R.map(() => 0n), 0n]"),
    ("differentiable ? slack.filter((x) => x.sign) : [Q.zero]", "slack.filter((x) => x.sign)"),
    ("out !== null && !out.exchanged &&", "out !== null &&"),
    ("j > i ? S[j][i] : x", "x"),
    ("checkWrenches(P, fractions,", "void (P, fractions,"),
    ("gap.atMost(limit(x)),", "true,"),
    ("proved.atMost(gap) &&", ""),
    ("inDualCones(P, prime,", "void (P, prime,"),
    ('inDualCones(P, lam, "lam");', ""),
    ("bound <= 1e-13", "bound <= 1e-12"),
    ("bound >= 0 && bound", "bound"),
    ("gap.sign >= 0 && gap.atMost", "gap.atMost"),
    ('<= 1, "error_bound', '<= 2, "error_bound'),
    ("y.every((x) => x.sign >= 0) && dot(y, P.b).sign > 0", "dot(y, P.b).sign > 0"),
    ("dot(y, P.b).sign > 0", "dot(y, P.b).sign >= 0"),
    ("W[i - 1] < w", "W[i - 1] <= w"),
    ("String(kept)", "String(workingSet(P, cert.active))"),
    ("need(P.contacts.every(open) &&", "need("),
    ("open) && s.slice(P.own.first).every((y) => y.sign >= 0)", "open)"),
    ("e > 15", "e > 16"),
    ("e < -4", "e < -5"),
    ("Object.is(cert.error_bound, 0)", "cert.error_bound === 0"),
    ("c.rows === 6 ? Q.of(c.mu_omega) : zero", "Q.of(c.mu_omega)"),
    ('sameLeast(cert, "smallest_active', 'void (cert, "smallest_active'),
)
"""A piece of text that occurs once, and what is put in its place."""
REFUSAL = re.compile(r"\b(?:need|json)\(")


def faults(text: str) -> Iterator[tuple[str, str]]:
    """What each fault is, and the checker with it.

    Parameters
    ----------
    text : str
        The checker as it is.
    """
    for found in REFUSAL.finditer(text):
        rest = text[found.end() :]
        yield f"without: {rest.splitlines()[0][:80]}", f"{text[: found.start()]}void ({rest}"
    for old, new in CHANGES:
        if text.count(old) != 1:
            raise ValueError(f"{old!r} occurs {text.count(old)} times")
        yield f"{old} -> {new}", text.replace(old, new)


def noticed(path: Path, parts: list[list[Case]]) -> bool:
    """Whether a checker and `verify` disagree on a case, or the checker fails as a whole."""
    for cases in parts:
        try:
            said = verdicts(cases, path)
        except subprocess.CalledProcessError:
            return True
        if any(disagreement(*pair) for pair in zip(cases, said, strict=True)):
            return True
    return False


def main() -> int:
    """Print the table; exit status 1 if a fault is not noticed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="write the table here too")
    options = parser.parse_args()
    counts, unseen = Counter[str](), []
    with TemporaryDirectory() as folder:
        cases = list(all_cases(Path(folder), whole=False))
        parts = [[c for c in cases if bool(c.reason) == alone] for alone in (True, False)]
        path = Path(folder) / "verify.js"
        path.write_text(VERIFIER.read_text())
        if noticed(path, parts):
            sys.exit("the two checkers disagree: python -m validation.tools.check_verifier")
        for fault, text in faults(VERIFIER.read_text()):
            path.write_text(text)
            kind = "a refusal taken out" if fault.startswith("without: ") else "a change"
            by = next((i for i in range(2) if noticed(path, parts[i : i + 1])), 2)
            counts[f"{kind}, {by}"] += 1
            unseen += [fault] if by == 2 else []
    lines = ["| fault | planted | noticed by files with one fault | by the others | by none |"]
    lines.append("|-" * 5 + "|")
    for kind in ("a refusal taken out", "a change"):
        found = [counts[f"{kind}, {by}"] for by in range(3)]
        lines.append(f"| {kind} | {sum(found)} | {' | '.join(map(str, found))} |")
    print(*lines, *unseen, sep="\n")
    if options.out:
        text_written(options.out, HEAD + "\n".join(lines) + "\n")
    return int(bool(unseen))


HEAD = """# Faults planted in the second checker

Made by `python -m validation.make.verifier_faults`, whose first lines say what is done.

"""

if __name__ == "__main__":
    sys.exit(main())
