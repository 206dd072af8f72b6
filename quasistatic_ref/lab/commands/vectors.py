"""``vectors check|challenge|generate|own``: for other implementations."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from quasistatic_ref.cli import options as shared
from quasistatic_ref.cli.main import parsers_of
from quasistatic_ref.lab.folders import vectors_folder

ACTIONS = {
    "check": "compare a folder of answers with the vectors, layer by layer",
    "challenge": "ask a program new cases, and show those that it gets wrong",
    "generate": "write the whole folder: expected outputs are copied, those of new cases added",
    "own": "write this package's own float64 answers, in the form of yours",
}
OUT = {"own": "answers"}
"""Where an action writes; ``vectors`` otherwise."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Declare the actions of this command and their options."""
    for name, action in parsers_of(parser, "action", ACTIONS).items():
        if name == "challenge":
            _add_challenge(action)
            continue
        words = "folder of vectors (default: that of the package)"
        action.add_argument("--vectors", type=Path, metavar="FOLDER", help=words)
        if name == "check":
            action.add_argument("answers", type=Path, metavar="ANSWERS", help="folder of answers")
            shared.add(action, "--json")
            _add_digits(action)
            words = "only cases whose ids begin so, e.g. rows/cone; may be given several times"
            action.add_argument("--only", metavar="PREFIX", action="append", default=[], help=words)
            action.add_argument("--case", metavar="ID", help="show one case, number by number")
        else:
            shared.add(action, "--out", default=Path(OUT.get(name, "vectors")))
        if name in ("check", "own"):
            _add_layers(action)


def _add_digits(action: argparse.ArgumentParser) -> None:
    words = "accept answers that are right to D digits"
    action.add_argument("--digits", type=float, metavar="D", help=words)


def _add_layers(action: argparse.ArgumentParser) -> None:
    words = "look at this layer only; may be given several times"
    action.add_argument("--layer", action="append", metavar="NAME", dest="layers", help=words)


def _add_challenge(action: argparse.ArgumentParser) -> None:
    """Who is challenged, by what, and for how long."""
    say = action.add_argument
    say("--command", metavar="COMMAND", dest="program", help="program to ask, e.g. './my_sim'")
    _add_layers(action)
    say("--cases", type=int, metavar="N", help="how many cases (1,000, unless --seconds is given)")
    say("--seconds", type=float, metavar="S", help="ask cases for S seconds")
    say("--seed", type=int, default=0, metavar="K", help="seed of the random cases (default: 0)")
    words = "time that the program has for an answer (default: 10 s)"
    say("--timeout", type=float, default=10.0, metavar="S", help=words)
    say("--again", type=Path, metavar="FILE", help="ask the case of a counterexample once more")
    _add_digits(action)
    shared.add(action, "--out", default=Path("counterexamples"))
    shared.add(action, "--json")


def run(options: argparse.Namespace) -> int:
    """Do one of the actions."""
    from quasistatic_ref.lab.vectors.files import check_layer

    words = [("--layer", name) for name in getattr(options, "layers", None) or ()]
    if options.action == "check":
        words += [("--only", prefix) for prefix in options.only]
        words += [("--case", options.case)] if options.case else []
    for option, word in words:
        check_layer(word.partition("/")[0], f"{option} {word}")
    return RUNS[options.action](options)


def _challenge(options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.processes import ends_in_order
    from quasistatic_ref.lab.vectors.challenge.command import challenge_status

    with ends_in_order():
        return challenge_status(options)


def _check(options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.vectors.check.folder import check_answers

    source = _vectors(options)
    only = [options.case] if options.case else options.only
    report = check_answers(
        options.answers, source, options.layers, only=only, digits=options.digits
    )
    if options.json:
        shared.print_json(report.record)
        return report.status
    if not options.quiet or not report.ok:
        shared.print_rows(report.rows)
    if options.case:
        _show_case(options, source)
    if not options.quiet or not report.ok:
        for sentence in report.sentences:
            print(f"quasistatic-ref: {sentence}", file=sys.stderr)
    return report.status


def _show_case(options: argparse.Namespace, source: Path) -> None:
    """Expected and given of one case, in the package's conventions."""
    from quasistatic_ref.lab.vectors.check.answers import answers_read
    from quasistatic_ref.lab.vectors.check.folder import answer_judged
    from quasistatic_ref.lab.vectors.check.side_by_side import side_by_side
    from quasistatic_ref.lab.vectors.files import expected_read, inputs_read

    layer = options.case.partition("/")[0]
    answers = answers_read(options.answers, layer)
    for case in inputs_read(source, layer):
        if case.id == options.case and case.id in answers.outputs:
            record = expected_read(source, layer)[case.id]
            answer = answers.outputs[case.id]
            verdict, output = answer_judged(layer, case, record, answer, answers, options.digits)
            print(f"{case.id}: {case.provenance}: {verdict.verdict} {verdict.reason}")
            shared.print_rows(side_by_side(record["output"], output))


def _vectors(options: argparse.Namespace) -> Path:
    """The folder of vectors of ``--vectors``; by default that which comes along."""
    folder: Path | None = options.vectors
    return vectors_folder() if folder is None else folder


def _generate(options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.vectors.generate import generate_folder

    counts = generate_folder(_vectors(options), options.out, not options.quiet)
    shared.print_rows([("layer", "cases"), *((name, str(n)) for name, n in counts.items())])
    print(f"wrote {sum(counts.values())} cases to {options.out}")
    return 0


def _own(options: argparse.Namespace) -> int:
    from quasistatic_ref.lab.vectors.generate import own_written
    from quasistatic_ref.lab.vectors.layers import LAYERS

    names = options.layers or LAYERS
    for path in own_written(_vectors(options), options.out, names, not options.quiet):
        print(path)
    return 0


RUNS: dict[str, Callable[[argparse.Namespace], int]] = {
    "check": _check,
    "challenge": _challenge,
    "generate": _generate,
    "own": _own,
}
