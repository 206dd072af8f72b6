"""Mistakes planted in programs that do less, and what ``vectors challenge`` makes of each.

``python -m validation.make.partial_ports`` (some minutes). A program that answers boxes and
half-spaces only, with one mistake planted, is challenged within its declared scope: whether the
mistake was found, and which was named. Exit status 1 if one is not found, or fewer than 8 named.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.check.patched import program
from quasistatic_ref.lab.vectors.check.scope import Scope

RESULTS = Path(__file__).parents[1] / "results" / "partial_ports.md"
SCOPE = Scope(
    "boxes and half-spaces",
    layers=("jacobian", "rows", "wrench", "integrate", "step"),
    shapes=("box", "halfspace"),
    cones=("pyramid",),
    farkas=False,
)
CASES = 96
"""Of which each challenge asks at most so many."""
NAMED = 8
BUGS = {
    "size of phi in b": """rows.py:
- b.extend([-c["phi"]] * len(found))
+ b.extend([-abs(c["phi"])] * len(found))""",
    "spin of beta only": """mechanism.py:
- spin = np.array(contact["n"]) @ (w_beta - w_alpha)
+ spin = np.array(contact["n"]) @ w_beta""",
    "tangents by another rule": """candidates.py:
- i = int(np.argmin(np.abs(n)))
+ i = int(abs(n[0]) > 0.9)""",
    "sign of b": """rows.py:
- b.extend([-c["phi"]] * len(found))
+ b.extend([c["phi"]] * len(found))""",
    "spin sign": """mechanism.py:
- spin = np.array(contact["n"]) @ (w_beta - w_alpha)
+ spin = np.array(contact["n"]) @ (w_alpha - w_beta)""",
    "spin rows exchanged": """rows.py:
- spins = [[0, 0, 1], [0, 0, -1]]
+ spins = [[0, 0, -1], [0, 0, 1]]""",
    "one point in the place of alpha and beta": """mechanism.py:
- beta = np.array(contact["beta"])
+ beta = alpha""",
    "lam and force mixed up by h": """wrench.py:
- lam = np.array(c["lam"]) / h
+ lam = np.array(c["lam"])""",
    "M/h^2 in the place of M/h": """step.py:
- H[n_a:, n_a:] = M[n_a:, n_a:] / h
+ H[n_a:, n_a:] = M[n_a:, n_a:] / h**2""",
    "h missing in g": """step.py:
- g = h * tau
+ g = tau""",
}
"""What is planted -> the lines of the plain program that it replaces."""


def trial(patch: str, cases: int) -> tuple[int, tuple[str, ...]]:
    """How many findings a challenge has, and which mistakes it names."""
    outcome = challenge(program(patch), scope=SCOPE, cases=cases, first=True)
    names = (name for finding in outcome.findings for name in finding.mistakes)
    return len(outcome.findings), tuple(dict.fromkeys(names))


def written(bugs: dict[str, str], cases: int) -> tuple[str, bool]:
    """The page, and whether enough was found and named."""
    lines, named, found = [], 0, 0
    for name, patch in bugs.items():
        count, names = trial(patch, cases)
        found += count > 0
        named += name in names
        lines.append((name, str(count), ", ".join(names) or "-"))
    table = "\n".join(markdown_table(("planted", "findings", "named"), lines))
    text = (
        f"# Mistakes planted in a program of {SCOPE.name}\n\nThe plain program, challenged within "
        f"its scope ({', '.join(SCOPE.layers)}; no Farkas vectors) with at most {cases} cases: "
        f"{found} of {len(bugs)} mistakes are found, and {named} named.\n\n{table}\n"
    )
    return text, found == len(bugs) and named >= min(NAMED, len(bugs))


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=len(BUGS), help="so many of the mistakes")
    parser.add_argument("--cases", type=int, default=CASES, help="of each challenge, at most")
    parser.add_argument("--out", type=Path, default=RESULTS)
    options = parser.parse_args()
    text, good = written(dict(list(BUGS.items())[: options.count]), options.cases)
    print(text_written(options.out, text))
    raise SystemExit(int(not good))


if __name__ == "__main__":
    main()
