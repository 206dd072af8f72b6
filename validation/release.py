"""Every committed result made again, and what changed: ``python -m validation.release``.

Each result is a command and the paths that it writes. The commands run one after the other (an hour
or two on two cores in all; name results to make only those, ``--list`` shows them), and then git
says what differs from the last commit: nothing, or only what depends on the machine (times), is
what a release wants. Files are compared as bytes, pictures by their pixels.

Exit status 1 if a command failed. What changed is for a person to judge, and is printed.
"""

from __future__ import annotations

import argparse
import io
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import image

ROOT = Path(__file__).parent.parent
CLI = "quasistatic_ref.cli.main"


@dataclass(frozen=True)
class Result:
    """Something that is committed, and the command that makes it.

    Parameters
    ----------
    name : str
    command : tuple of str
        Arguments of ``python -m``, run in the root of the repository; ``{temporary}`` is a folder.
    writes : tuple of str
        Committed files or folders that it makes, relative to the root.
    copied : tuple of (str, str)
        What is copied after it from the temporary folder: a pattern, and a committed folder.
    output : str
        The committed file that keeps the command's standard output, if one does.
    """

    name: str
    command: tuple[str, ...]
    writes: tuple[str, ...]
    copied: tuple[tuple[str, str], ...] = ()
    output: str = ""

    @property
    def available(self) -> bool:
        """Whether its module, and for a sub-command that as well, exists in this checkout."""
        module = self.command[0]
        file = ROOT / Path(*module.split(".")).with_suffix(".py")
        if module != CLI:
            return file.exists()
        commands = ROOT / "quasistatic_ref" / "lab" / "commands"
        return (commands / f"{self.command[1]}.py").exists()


REALITY = ("pushes", "identified", "loads", "errors", "ablations", "tripods")
"""Figures of docs/reality.md."""

RESULTS = (
    Result(
        "compilers",
        ("validation.compilers", "--out", "validation/results/compilers.md"),
        ("validation/results/compilers.md",),
    ),
    Result(
        "memory_of_steps",
        ("validation.memory_of_steps",),
        ("validation/results/memory_of_steps.md",),
        output="validation/results/memory_of_steps.md",
    ),
    Result(
        "vectors",
        (CLI, "vectors", "generate", "--out", "validation/vectors"),
        ("validation/vectors",),
    ),
    Result(
        "planted_bugs",
        ("validation.planted_bugs", "--out", "validation/results/planted_bugs.md"),
        ("validation/results/planted_bugs.md",),
    ),
    Result(
        "challenges",
        ("validation.challenges", "--out", "validation/results/challenges.md"),
        ("validation/results/challenges.md",),
    ),
    Result(
        "engines",
        ("validation.engines.__main__",),
        ("validation/engines",),
    ),
    Result(
        "claims",
        (CLI, "validate", "--out", "{temporary}"),
        ("validation/claims.md", "validation/figures"),
        copied=(("claims.md", "validation"), ("figures/*.png", "validation/figures")),
    ),
    Result(
        "figures",
        (CLI, "figures", "grasp", "cone_surfaces", "pinch_threshold",
         "gradient_of_a_push", "where_no_gradient_is",
         "what_smoothing_does", "plan_a_push",
         "--out", "{temporary}"),
        ("docs/figures",),
        copied=(("*.png", "docs/figures"),),
    ),
    Result(
        "digits_of_backends",
        ("validation.digits_of_backends",),
        ("validation/results/digits_of_backends.csv", "docs/figures/digits_of_backends.png"),
    ),
    Result(
        "options_of_backends",
        ("validation.options_of_backends",),
        ("validation/results/options_of_backends.csv",),
        output="validation/results/options_of_backends.csv",
    ),
    Result(
        "large_steps",
        ("validation.large_steps",),
        ("validation/results/large_steps.md",),
        output="validation/results/large_steps.md",
    ),
    Result(
        "contact_qp",
        ("validation.contact_qp",),
        (
            "validation/results/contact_qp.csv",
            "validation/results/contact_qp.md",
            "docs/figures/contact_qp.png",
        ),
    ),
    Result(
        "sequences",
        (CLI, "study", "sequences", "daqp", "osqp", "clarabel", "piqp", "quadprog",
         "qpsolvers:daqp", "--repetitions", "1", "--quiet"),
        ("validation/results/sequences.txt",),
        output="validation/results/sequences.txt",
    ),
    Result(
        "curved_pairs",
        ("validation.curved_pairs", "--out", "validation/results/curved_pairs.md"),
        ("validation/results/curved_pairs.md",),
    ),
    Result(
        "pair_distances",
        ("validation.pair_distances",),
        ("validation/pair_distances.md",),
        output="validation/pair_distances.md",
    ),
    Result(
        "load_robots",
        ("validation.load_robots",),
        ("validation/load_robots.md",),
        output="validation/load_robots.md",
    ),
    Result(
        "step_profile",
        ("validation.step_profile",),
        ("validation/step_profile.md",),
        output="validation/step_profile.md",
    ),
    Result(
        "exact_everywhere",
        ("validation.exact_everywhere", "--out", "validation/results/exact_everywhere.txt"),
        ("validation/results/exact_everywhere.txt",),
    ),
    Result(
        "forgeries",
        ("validation.forgeries", "--out", "validation/forgeries.md"),
        ("validation/forgeries.md",),
    ),
    Result(
        "verifier",
        ("validation.check_verifier", "--all", "--out", "validation/results/verifier.md"),
        ("validation/results/verifier.md",),
    ),
    Result(
        "verifier_faults",
        ("validation.verifier_faults", "--out", "validation/results/verifier_faults.md"),
        ("validation/results/verifier_faults.md",),
    ),
    Result(
        "confirmed_bits",
        ("validation.confirmed_bits", "--out", "validation/results/confirmed_bits.txt"),
        ("validation/results/confirmed_bits.txt",),
    ),
    Result(
        "same_bits",
        ("validation.same_bits", "--out", "validation/results/same_bits.json"),
        ("validation/results/same_bits.json",),
    ),
    Result(
        "derivatives",
        ("validation.derivatives", "--out", "validation/results/derivatives.md"),
        ("validation/results/derivatives.md",),
    ),
    Result(
        "derivative_states",
        ("validation.derivative_states", "--out", "validation/results/derivative_states.md"),
        ("validation/results/derivative_states.md",),
    ),
    Result(
        "derivative_kinks",
        ("validation.derivative_kinks", "--out", "validation/results/derivative_kinks.md"),
        ("validation/results/derivative_kinks.md",),
    ),
    Result(
        "push_plans",
        ("validation.push_plans", "--out", "validation/results/push_plans.md"),
        ("validation/results/push_plans.md",),
    ),
    Result(
        "bench_exact",
        ("validation.bench_exact", "200"),
        ("validation/results/bench_exact.txt",),
        output="validation/results/bench_exact.txt",
    ),
    Result(
        "fuzzing",
        ("validation.fuzz", "--out", "{temporary}", "--table", "validation/results/fuzzing.md"),
        ("validation/results/fuzzing.md",),
    ),
    Result(
        "hostile_steps",
        ("validation.fuzz", "--readers", "validation.hostile_steps", "--inputs", "105000",
         "--out", "{temporary}", "--table", "validation/results/hostile_steps.md"),
        ("validation/results/hostile_steps.md",),
    ),
    Result(
        "mutations",
        ("validation.mutations", "--stale"),
        ("validation/results/mutations.md",),
    ),
    Result(
        "reality_identified",
        ("validation.reality_identified",),
        ("validation/results/reality_identified.json",),
    ),
    Result(
        "reality",
        (CLI, "validate", "reality", "--out", "{temporary}"),
        ("validation/results/reality.json", "validation/results/reality.csv"),
        copied=(("reality.json", "validation/results"), ("reality.csv", "validation/results")),
    ),
    Result(
        "reality_residuals",
        ("validation.reality_residuals",),
        ("validation/results/reality_residuals.json",),
    ),
    Result(
        "reality_ablations",
        ("validation.reality_ablations", "--every", "30", "--work", "{temporary}"),
        ("validation/results/reality_ablations.json",),
    ),
    Result(
        "reality_tripods",
        ("validation.reality_tripods",),
        ("validation/results/reality_tripods.json",),
    ),
    Result(
        "reality_figures",
        ("validation.reality_figures", "--out", "{temporary}"),
        tuple(f"docs/figures/reality_{name}.png" for name in REALITY),
        copied=(("reality_*.png", "docs/figures"),),
    ),
    Result(
        "bench",
        (CLI, "bench", "--out", "validation/benchmarks"),
        ("validation/benchmarks",),
    ),
    Result(
        "installs",
        ("validation.check_installs", "--out", "validation/results/installs.md"),
        ("validation/results/installs.md",),
    ),
    Result(
        "option_search",
        ("validation.option_search",),
        ("validation/results/option_search.jsonl",),
    ),
    *(
        Result(
            f"study_{name}",
            ("validation.study_reports", name),
            (f"validation/studies/{name}",),
        )
        for name in ("default", "bunny_torsion")
    ),
)  # fmt: skip


def made(result: Result) -> bool:
    """Run a result's command, and put what it made where it belongs; False if it failed."""
    with tempfile.TemporaryDirectory() as temporary:
        arguments = [argument.format(temporary=temporary) for argument in result.command]
        command = [sys.executable, "-m", *arguments]
        done = subprocess.run(
            command, cwd=ROOT, stdout=subprocess.PIPE if result.output else None, check=False
        )
        if done.returncode:
            return False  # what it would have written is left as it was
        if result.output:
            (ROOT / result.output).write_bytes(done.stdout)
        for pattern, folder in result.copied:
            for file in sorted(Path(temporary).glob(pattern)):
                shutil.copy(file, ROOT / folder / file.name)
    return True


def git(*arguments: str) -> bytes:
    """Standard output of a git command in the repository."""
    return subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, check=True).stdout


def changes(paths: tuple[str, ...]) -> list[str]:
    """One line for each committed file among these paths that is now another, new or gone."""
    said = git("status", "--porcelain", "-z", "--untracked-files=all", "--", *paths).decode()
    lines = []
    for entry in filter(None, said.split("\0")):
        state, name = entry[:2].strip(), entry[3:]
        if state == "??":
            lines.append(f"{name}: new")
        elif state == "D":
            lines.append(f"{name}: gone")
        elif name.endswith(".png"):
            lines += [f"{name}: {said}"] if (said := picture_change(name)) else []
        else:
            added, removed, _ = git("diff", "--numstat", "HEAD", "--", name).decode().split("\t")
            lines.append(f"{name}: {removed} lines are now {added} others")
    return lines


def picture_change(name: str) -> str:
    """How a picture differs from the committed one; nothing if all its pixels are the same."""
    before = image.imread(io.BytesIO(git("show", f"HEAD:{name}")), format="png")
    after = image.imread(ROOT / name)
    if before.shape != after.shape:
        (old_height, old_width), (height, width) = before.shape[:2], after.shape[:2]
        return f"{old_width} x {old_height} pixels are now {width} x {height}"
    share = float((np.abs(before - after).max(axis=2) > 0).mean())
    return f"{100 * share:.2f} % of its pixels differ" if share else ""


def main() -> None:
    """Make what is asked for, then print what changed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="all results by default")
    parser.add_argument("--list", action="store_true", help="name the results and their files")
    options = parser.parse_args()
    known = {result.name: result for result in RESULTS if result.available}
    if options.list:
        for result in known.values():
            print(f"{result.name}: {', '.join(result.writes)}")
        return
    unknown = [name for name in options.names if name not in known]
    if unknown:
        sys.exit(f"{unknown[0]} is no result of this checkout; there are {', '.join(known)}")
    failed, report = [], []
    for name in options.names or known:
        print(f"== {name}", flush=True)
        begun = time.perf_counter()
        if not made(known[name]):
            failed.append(name)
        told = changes(known[name].writes) or ["as committed"]
        report += [f"{name} ({time.perf_counter() - begun:.0f} s)", *(f"  {one}" for one in told)]
    print("== what changed since the last commit", *report, sep="\n")
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
