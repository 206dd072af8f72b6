"""Every committed result made again, and what changed: ``python -m validation.tools.release``.

Each result is a command and the paths that it writes. The commands run one after the other (an hour
or two on two cores in all; name results to make only those, ``--list`` shows them), and then git
says what differs from the last commit: nothing, or only what depends on the machine (times), is
what a release wants.

Exit status 1 if a command failed. What changed is for a person to judge, and is printed.
"""

import argparse
import sys
import time

from validation.tools.remade import CLI, Result, changes, made, printed, written

REALITY = ("pushes", "identified", "loads", "errors", "ablations", "tripods")
"""Figures of docs/reality.md."""

RESULTS = (
    Result(
        "environments",
        ("validation.make.environments", "--out", "validation/results/environments.md"),
        ("validation/results/environments.md",),
    ),
    Result(
        "vectors",
        (CLI, "vectors", "generate", "--out", "validation/vectors"),
        ("validation/vectors",),
    ),
    written("planted_bugs", "validation/results/planted_bugs.md"),
    written("challenges", "validation/results/challenges.md"),
    Result(
        "engines",
        ("validation.make.engines",),
        ("validation/results/engines",),
    ),
    Result(
        "claims",
        (CLI, "validate", "--out", "{temporary}"),
        ("validation/results/claims.md", "validation/results/figures"),
        copied=(("claims.md", "validation/results"),
                ("figures/*.png", "validation/results/figures")),
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
        ("validation.make.digits_of_backends",),
        ("validation/results/digits_of_backends.csv", "docs/figures/digits_of_backends.png"),
    ),
    printed("options_of_backends", "validation/results/options_of_backends.csv"),
    printed("large_steps", "validation/results/large_steps.md"),
    Result(
        "contact_qp",
        ("validation.make.contact_qp",),
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
    printed("pair_distances", "validation/results/pair_distances.md"),
    printed("step_profile", "validation/results/step_profile.md"),
    printed("random_mechanisms", "validation/results/random_mechanisms.md"),
    written("exact_everywhere", "validation/results/exact_everywhere.txt"),
    written("forgeries", "validation/results/forgeries.md"),
    written("attacks", "validation/results/attacks.md"),
    Result(
        "verifier",
        ("validation.tools.check_verifier", "--all", "--out", "validation/results/verifier.md"),
        ("validation/results/verifier.md",),
    ),
    written("verifier_faults", "validation/results/verifier_faults.md"),
    written("confirmed_bits", "validation/results/confirmed_bits.txt"),
    written("same_bits", "validation/results/same_bits.json"),
    written("derivative_states", "validation/results/derivative_states.md"),
    Result(
        "bench_exact",
        ("validation.make.bench_exact", "200"),
        ("validation/results/bench_exact.txt",),
        output="validation/results/bench_exact.txt",
    ),
    Result(
        "fuzzing",
        ("validation.tools.fuzz", "--out", "{temporary}",
         "--table", "validation/results/fuzzing.md"),
        ("validation/results/fuzzing.md",),
    ),
    Result(
        "hostile_steps",
        ("validation.tools.fuzz", "--readers", "validation.make.hostile_steps",
         "--inputs", "105000", "--out", "{temporary}",
         "--table", "validation/results/hostile_steps.md"),
        ("validation/results/hostile_steps.md",),
    ),
    Result(
        "aligned_poses",
        ("validation.make.aligned_poses",),
        ("validation/results/aligned_poses.md",),
    ),
    Result("outputs", ("validation.make.outputs",), ("validation/results/outputs.md",)),
    Result(
        "mutations",
        ("validation.tools.mutations", "--stale"),
        ("validation/results/mutations.md",),
    ),
    Result(
        "reality_identified",
        ("validation.make.reality_identified",),
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
        ("validation.make.reality_residuals",),
        ("validation/results/reality_residuals.json",),
    ),
    Result(
        "reality_ablations",
        ("validation.make.reality_ablations", "--every", "30", "--work", "{temporary}"),
        ("validation/results/reality_ablations.json",),
    ),
    Result(
        "reality_tripods",
        ("validation.make.reality_tripods",),
        ("validation/results/reality_tripods.json",),
    ),
    Result(
        "reality_figures",
        ("validation.make.reality_figures", "--out", "{temporary}"),
        tuple(f"docs/figures/reality_{name}.png" for name in REALITY),
        copied=(("reality_*.png", "docs/figures"),),
    ),
    Result(
        "bench",
        (CLI, "bench", "--out", "validation/results/benchmarks"),
        ("validation/results/benchmarks",),
    ),
    Result(
        "installs",
        ("validation.tools.check_installs", "--out", "validation/results/installs.md"),
        ("validation/results/installs.md",),
    ),
    Result(
        "option_search",
        ("validation.make.option_search",),
        ("validation/results/option_search.jsonl", "validation/results/option_search.md"),
    ),
    *(
        Result(
            f"study_{name}",
            ("validation.make.study_reports", name),
            (f"validation/studies/{name}",),
        )
        for name in ("default", "bunny_torsion")
    ),
)  # fmt: skip


def main() -> None:
    """Make the results that are named, then print what changed."""
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
        differences = changes(known[name].writes) or ["as committed"]
        report += [
            f"{name} ({time.perf_counter() - begun:.0f} s)",
            *(f"  {one}" for one in differences),
        ]
    print("== what changed since the last commit", *report, sep="\n")
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
