"""``study problems``: sets of problems with exact answers, without a study."""

import argparse
import sys
from collections import Counter
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.main import parsers_of
from quasistatic_ref.lab.folders import CONTACT_QP, contact_qp_folder
from quasistatic_ref.lab.study.problems.names import NATURAL, RAW, UNITS

ACTIONS = {
    "list": "the families of a set, their dials, and how many problems they have",
    "export": "write problems as a test set of qpbenchmark, with their exact answers",
    "check": "compare a set's files with its hashes; with --exact prove every answer again",
}


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the commands below ``study problems``."""
    parsers = parsers_of(parser, "problems", ACTIONS)
    for name in ("list", "export", "check"):
        words = "contact-qp, which comes along, or the folder of a set"
        parsers[name].add_argument("set", nargs="?", metavar="SET", default=CONTACT_QP, help=words)
    export = parsers["export"]
    export.add_argument("--units", default=RAW, choices=UNITS, help="raw (SI) or natural")
    export.add_argument("--every", type=int, default=1, metavar="N", help="each N-th problem only")
    for one, words in (("--families", "only these, commas between"), ("--tag", "only such ones"),
                       ("--id", "one problem only")):  # fmt: skip
        export.add_argument(one, metavar=one[2:].upper(), help=words)
    shared.add(export, "--out", default=Path("problems"))
    parsers["check"].add_argument(
        "--exact", action="store_true", help="prove every answer again (minutes, no solver)"
    )
    for name in ("list", "check"):
        shared.add(parsers[name], "--json")


def run_problems(options: argparse.Namespace) -> int:
    """Run the action that was named."""
    runs = {"list": _list, "export": _export, "check": _check}
    return runs[options.problems](options)


def _list(options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.study.problems.folder import manifest

    head = manifest(contact_qp_folder(options.set))
    if options.json:
        shared.print_json(head)
        return 0
    rows: list[tuple[str, ...]] = [("family", "problems", "dial", "from", "to", "unit")]
    for name, family in head["families"].items():
        dial = family["dial"] or {"name": "", "first": "", "most": "", "unit": ""}
        ends = (str(dial["first"]), str(dial["most"]))
        rows.append((name, str(family["count"]), dial["name"], *ends, dial["unit"]))
    shared.print_rows(rows)
    print(f"{head['name']}: {head['count']} problems")
    return 0


def _export(options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.study.problems.exports import exported_files, has_place
    from quasistatic_ref.lab.study.problems.folder import manifest, set_read

    shared.check_at_least_one(options, "every")
    folder = contact_qp_folder(options.set)
    families = options.families.split(",") if options.families else None
    chosen = [
        one
        for one in set_read(folder, families)
        if options.id in (None, one.id) and options.tag in (None, *one.facts["tags"])
    ]
    chosen = chosen[:: options.every]
    natural = options.units == NATURAL
    problems = [one.natural for one in chosen] if natural else chosen
    name = manifest(folder)["name"] + ("-natural" if natural else "")
    paths = exported_files(name, problems, options.out)
    print(f"wrote {len(paths)} files to {options.out}, README.md among them")
    if left := sum(not has_place(one) for one in chosen):
        words = "the format has no place for their cones or missing solutions"
        print(f"quasistatic-ref: left out {left} problems: {words}", file=sys.stderr)
    return 0


def _check(options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.study.problems.checking import refutation
    from quasistatic_ref.lab.study.problems.folder import manifest, set_read
    from quasistatic_ref.simulate.progress import progress_bar

    folder = contact_qp_folder(options.set)
    problems = set_read(folder)
    others = manifest(folder)["count"] - len(problems)
    wrong = {}
    if options.exact:
        with progress_bar(total=len(problems), unit="problem", words="proved again",
                          shown=not options.quiet) as bar:  # fmt: skip
            for one in problems:
                why = refutation(one)
                if why is not None:
                    wrong[one.id] = why
                bar.update()
    kinds = Counter(one.answer.kind if not one.answer.farkas else "infeasible" for one in problems)
    if options.json:
        report = {"problems": len(problems), "answers": kinds, "without a proof": others,
                  "refuted": wrong}  # fmt: skip
        shared.print_json(report)
        return int(bool(wrong))
    counted = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
    print(f"{len(problems)} problems, as the manifest lists them: {counted}")
    if others:
        print(f"{others} more are not read: their answers are not proved")
    if options.exact:
        print(f"{len(problems) - len(wrong)} answers proved again, {len(wrong)} refuted")
    for name, why in wrong.items():
        print(f"quasistatic-ref: {name}: {why}", file=sys.stderr)
    return int(bool(wrong))
