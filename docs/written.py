"""What pages repeat is written between comment markers: ``python -m docs.written [--check]``.

``<!-- code FILE OBJECT -->`` stands before a function, a class or a method of a source file, and
``<!-- code FILE OBJECT | from WORDS | to WORDS -->`` before its lines from one with some words to
one with others, or ``before`` it. It ends with ``<!-- end -->``.
``<!--number:NAME-->`` stands before a number of the committed results, in a line of text, and
``<!--end-->`` after it. With ``--check`` nothing is written, and the exit status is 1 if a page
would change.
"""

import ast
import json
import re
import sys
import textwrap
from pathlib import Path

from quasistatic_ref.lab.figures.clouds import is_held, rows

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
CODE = re.compile(
    r"(<!-- code (\S+) (\S+)(?: \| from ([^|]+?) \| (to|before) ([^|]+?))? -->\n).*?(<!-- end -->)",
    re.DOTALL,
)
NUMBER = re.compile(r"(<!--number:([\w-]+?)-->).*?(<!--end-->)")


def result(name):
    """A committed result."""
    return json.loads((ROOT / "validation" / "results" / f"{name}.json").read_text("utf-8"))


def numbers():
    """Each number by its name, as a page shows it."""
    return {**of_pushes(), **of_ratios(), **of_clouds(), **of_claims(), **of_study()}


def of_pushes():
    """Measured pushes: means over pairs, with their intervals."""
    record = result("reality")
    everything = record["pairs"]["all"]
    kinds = record["steps"]
    shown = {
        "pushes": f"{everything['pushes']:,}",
        "push-steps": f"{sum(kinds.values()):,}",
        "push-steps-enclosed": f"{kinds['enclosure']:,}",
        "push-steps-exact": f"{kinds['exact']:,}",
        "moved-mm": f"{everything['moved']['mean'][0]:.1f}",
        "moved-deg": f"{everything['moved']['mean'][1]:.1f}",
    }
    for end in ("low", "mean", "high"):
        for key in ("error", "published"):
            place, angle = everything[key][end]
            shown[f"{key}-{end}-mm"] = f"{place:.2f}"
            shown[f"{key}-{end}-deg"] = f"{angle:.2f}"
        place, angle = everything["more"][end]
        shown[f"more-{end}-mm"] = f"{place:+.2f}"
        shown[f"more-{end}-deg"] = f"{angle:+.2f}"
    return shown


def of_ratios():
    """Identified mu_omega / mu_v: the least and the largest, and relative to a uniform pressure."""
    pairs = result("reality_identified").values()
    ratios = [pair["ratio"] for pair in pairs]
    relative = [ratio / pair["uniform"] for ratio, pair in zip(ratios, pairs, strict=True)]
    return {
        "ratio-least-mm": f"{1e3 * min(ratios):.1f}",
        "ratio-largest-mm": f"{1e3 * max(ratios):.1f}",
        "ratio-least-of-uniform": f"{min(relative):.2f}",
        "ratio-largest-of-uniform": f"{max(relative):.2f}",
    }


def of_clouds():
    """Clouds of 992 points in the scene as it is."""
    scene = {"count": 992, "change": "none"}

    def held_of(sampling, mu_omega):
        kind = scene | {"sampling": sampling, "mu_omega": mu_omega}
        return f"{sum(is_held(row) for row in rows() if kind.items() <= row.items())}"

    whole = [row for row in rows() if scene.items() <= row.items() and row["sampling"] != "scan"]
    turns = [row["rotation"] for row in whole if row["mu_omega"] == 0]
    held = [is_held(row) for row in whole if row["mu_omega"] > 0]
    return {
        "clouds": f"{len(turns)}",
        "clouds-held": f"{sum(held)}",
        "cloud-least-deg": f"{min(turns):.1f}",
        "cloud-largest-deg": f"{max(turns):.1f}",
        "random-held-with": held_of("random", 0.003),
        "random-held-without": held_of("random", 0.0),
        "scan-held-with": held_of("scan", 0.003),
        "scan-held-without": held_of("scan", 0.0),
    }


def of_claims():
    """The grasp, as `quasistatic-ref validate` measured them."""
    page = (ROOT / "validation" / "results" / "claims.md").read_text("utf-8")
    turns = re.findall(r"^\| rotation (with|without) torsion \[deg\] \| 1 \| ([\d.]+)", page, re.M)
    return {
        **{f"grasp-{case}-deg": f"{float(turn):.1f}" for case, turn in turns},
    }


def of_study():
    """What solvers said in the study `default`, of all and of each."""
    page = (ROOT / "validation" / "studies" / "default" / "summary.md").read_text("utf-8")
    shown = {"study-problems": re.search(r"^(\d+) problems", page, re.M)[1]}
    table = page.partition("## What solvers say")[2].partition("## Who")[0]
    head, _, *lines = [line.strip("| ").split(" | ") for line in re.findall(r"^\|.*", table, re.M)]
    names = {
        "solved, reached, a solution": "reached",
        "solved, not reached, a solution": "not-reached",
        "solved, reached, no solution": "reached-none",
        "solved, not reached, no solution": "not-reached-none",
        "infeasible, a solution": "infeasible",
    }
    for line in lines:
        counts = dict(zip(head, line, strict=True))
        whose = "" if counts["solver"] == "all" else f"-{counts['solver']}"
        shown |= {f"study-{name}{whose}": counts[said] for said, name in names.items()}
    return shown


def code_of(file, name, first=None, ends=None, last=None):
    """The source of an object, or some of its lines, in a fence."""
    text = (ROOT / file).read_text("utf-8")
    node = ast.parse(text)
    for part in name.split("."):
        node = next(one for one in node.body if getattr(one, "name", None) == part)
    begin = min([node.lineno, *(one.lineno for one in node.decorator_list)])
    lines = text.splitlines()[begin - 1 : node.end_lineno]
    if first:
        start = next(k for k, line in enumerate(lines) if first in line)
        stop = next(k for k, line in enumerate(lines) if k >= start and last in line)
        lines = lines[start : stop + (ends == "to")]
    return "```python\n" + textwrap.dedent("\n".join(lines)).rstrip() + "\n```\n"


def written(text, shown):
    """A page with what its markers ask for."""
    text = CODE.sub(lambda m: m[1] + code_of(*m.group(2, 3, 4, 5, 6)) + m[7], text)
    return NUMBER.sub(lambda m: m[1] + shown[m[2]] + m[3], text)


def main(check):
    """Write the pages, or name those that would change."""
    shown = numbers()
    status = 0
    for path in PAGES:
        before = path.read_text("utf-8")
        after = written(before, shown)
        if after != before:
            print(path.relative_to(ROOT))
            status = int(check)
            if not check:
                path.write_text(after, "utf-8")
    return status


if __name__ == "__main__":
    sys.exit(main("--check" in sys.argv[1:]))
