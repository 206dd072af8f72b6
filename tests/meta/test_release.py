"""The release command knows every committed result, and says how each differs from its commit."""

from pathlib import Path

from validation.tools.release import RESULTS

ROOT = Path(__file__).parents[2]
# Written by a person who judged what was found, not by a command.
BY_HAND = {"validation/results/mutation_survivors.md", "validation/results/ports.md"}


def committed():
    folders = ("validation/results/*", "validation/results/figures/*.png", "docs/figures/*.png")
    folders = (*folders, "validation/*.md", "validation/results/benchmarks/*")
    return {str(p.relative_to(ROOT)) for folder in folders for p in ROOT.glob(folder)}


def test_every_committed_result_has_a_command():
    written = [path for result in RESULTS for path in result.writes]
    orphans = {
        name for name in committed() - BY_HAND if not any(name.startswith(w) for w in written)
    }
    assert orphans == set()
    assert len(committed()) > 15
