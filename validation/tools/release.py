"""Every committed result made again, and what changed: ``python -m validation.tools.release``.

Each result is a command and the paths that it writes. The commands run one after the other: most
take minutes, and mutations, prover_mutants, port_mutants, challenges, scans, solid_pairs and forces
hours, a day on two cores in all. Name results to make only those; ``--list`` shows them. Then git
says what differs from the last commit: nothing, or only what depends on the machine (times), is
what a release wants.

Exit status 1 if a command failed. What changed is for a person to judge, and is printed.
"""

import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from validation.tools.scripts import ROOT, script_options

CLI = "quasistatic_ref"
FIGURES = (
    "grasp cone_surfaces pinch_threshold gradient_of_a_push where_no_gradient_is "
    "what_smoothing_does plan_a_push both_laws solver_digits"
)
"""Of README and docs, by ``quasistatic-ref figures``."""
REALITY = ("pushes", "identified", "loads", "errors", "ablations", "tripods")
"""Figures of docs/reality.md."""


@dataclass(frozen=True)
class Result:
    """Something that is committed, and the command that makes it.

    Parameters
    ----------
    name : str
    command : str
        Arguments of ``python -m``, run in the root of the repository; ``{temporary}`` is a folder.
    writes : tuple of str
        Committed files or folders that it makes, relative to the root.
    copied : tuple of (str, str)
        What is copied after it from the temporary folder: a pattern, and a committed folder.
    """

    name: str
    command: str
    writes: tuple[str, ...]
    copied: tuple[tuple[str, str], ...] = ()


def to_file(name: str, ending: str = "md", command: str = "") -> Result:
    """What a command, else the script of that name, writes to the file that it is given."""
    path = f"validation/results/{name}.{ending}"
    return Result(name, f"{command or f'validation.make.{name}'} --out {path}", (path,))


RESULTS = (
    Result("vectors", f"{CLI} vectors generate --out validation/vectors", ("validation/vectors",)),
    Result(
        "fingerprints",
        "validation.make.fingerprints",
        ("quasistatic_ref/lab/vectors/check/fingerprints.json.gz",),
    ),
    Result(
        "planted_runs",
        "validation.make.planted_runs",
        ("quasistatic_ref/lab/oracle/planted.json.gz",),
    ),
    Result(
        "port_mutants",
        "validation.make.port_mutants --records {temporary}/port_mutants.jsonl "
        "--out validation/results/port_mutants.md",
        ("validation/results/port_mutants.md", "validation/results/port_mutants.jsonl"),
        (("port_mutants.jsonl", "validation/results"),),
    ),
    to_file("port_runs"),
    to_file("served_steps"),
    to_file("challenges"),
    to_file("vector_features", "csv"),
    Result("engines", "validation.make.engines", ("validation/results/engines",)),
    Result(
        "claims",
        f"{CLI} validate --out {{temporary}}",
        ("validation/results/claims.md", "validation/results/figures"),
        (("claims.md", "validation/results"), ("figures/*.png", "validation/results/figures")),
    ),
    Result(
        "figures",
        f"{CLI} figures {FIGURES} --out {{temporary}}",
        ("docs/figures",),
        (("*.png", "docs/figures"),),
    ),
    *map(
        to_file,
        (
            "large_steps",
            "proved_problems",
            "pair_distances",
            "scans",
            "solid_pairs",
            "step_profile",
            "run_hashes",
        ),
    ),
    to_file("attacks"),
    to_file("verifier", command="validation.tools.check_verifier --all"),
    to_file("confirmed_bits", "txt"),
    to_file("degenerate_bits", "txt"),
    to_file("same_bits", "json"),
    to_file("derivatives"),
    Result("clouds", "validation.make.clouds", ("validation/results/clouds.jsonl",)),
    Result(
        "second_order",
        "validation.make.second_order",
        ("validation/results/second_order.jsonl", "validation/results/second_order.md"),
    ),
    to_file("mjcf"),
    to_file("prover_mutants"),
    to_file("designed_steps"),
    to_file("mistakes"),
    to_file("guests"),
    to_file("mujoco_runs"),
    Result(
        "peer",
        "validation.make.peer --out {temporary}/peer.md",
        ("validation/results/peer.md", "validation/results/peer.json"),
        (("peer.*", "validation/results"),),
    ),
    to_file("environments"),
    to_file("forces_by_hand"),
    to_file("machines"),
    to_file("coulomb_modes"),
    to_file("forces"),
    Result("mutations", "validation.tools.mutations --stale", ("validation/results/mutations.md",)),
    to_file("reality_identified", "json"),
    Result(
        "reality",
        f"{CLI} validate reality --out {{temporary}}",
        ("validation/results/reality.json", "validation/results/reality.csv"),
        (("reality.json", "validation/results"), ("reality.csv", "validation/results")),
    ),
    to_file(
        "reality_ablations",
        "json",
        "validation.make.reality_ablations --every 30 --work {temporary}",
    ),
    to_file("reality_tripods", "json"),
    Result(
        "moving_figures",
        "validation.make.moving_figures --out {temporary}",
        ("docs/figures/grasp.gif", "docs/figures/sliding_block.gif"),
        (("*.gif", "docs/figures"),),
    ),
    Result(
        "reality_figures",
        "validation.make.reality_figures --out {temporary}",
        tuple(f"docs/figures/reality_{name}.png" for name in REALITY),
        (("reality_*.png", "docs/figures"),),
    ),
    Result(
        "bench",
        f"{CLI} bench --out validation/results/benchmarks",
        ("validation/results/benchmarks",),
    ),
    to_file("installs", command="validation.tools.check_installs"),
    *(
        Result(
            f"study_{name}",
            f"validation.make.study_reports {name}",
            (f"validation/studies/{name}",),
        )
        for name in ("default", "sequences")
    ),
)


def is_made(result: Result) -> bool:
    """Run a result's command, and put what it made where it belongs; False if it failed."""
    with tempfile.TemporaryDirectory() as temporary:
        command = [sys.executable, "-m", *shlex.split(result.command.format(temporary=temporary))]
        done = subprocess.run(command, cwd=ROOT, check=False)
        if done.returncode:
            return False  # what it would have written is left as it was
        for pattern, folder in result.copied:
            for file in sorted(Path(temporary).glob(pattern)):
                shutil.copy(file, ROOT / folder / file.name)
    return True


def main() -> None:
    """Make the results that are named, then print what changed."""
    known = {result.name: result for result in RESULTS}
    options = script_options(__doc__, known, list=False)
    if options.list:
        for result in RESULTS:
            print(f"{result.name}: {', '.join(result.writes)}")
        return
    chosen = [known[name] for name in options.names] or RESULTS
    failed = []
    for result in chosen:
        print(f"== {result.name}", flush=True)
        if not is_made(result):
            failed.append(result.name)
    print("== what changed since the last commit", flush=True)
    paths = [path for result in chosen for path in result.writes]
    for command in (("status", "--short"), ("diff", "--stat", "HEAD")):
        subprocess.run(["git", *command, "--", *paths], cwd=ROOT, check=True)
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
