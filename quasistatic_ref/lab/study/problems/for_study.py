"""The problems of a study: taken from a set, or made of steps, and kept in its folder."""

import hashlib
import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import json_text
from quasistatic_ref.lab.study.problems.boxes import problems_of_boxes
from quasistatic_ref.lab.study.problems.dials import MADE, SCENARIOS
from quasistatic_ref.lab.study.problems.folder import MANIFEST, manifest, set_read, set_written
from quasistatic_ref.lab.study.problems.making import problems_of_runs
from quasistatic_ref.lab.study.problems.problem import INFEASIBLE, Problem
from quasistatic_ref.lab.study.problems.selection import problems_taken, set_identity

FOLDER = "problems"
"""Within that of a study."""


@dataclass(frozen=True)
class TestSet:
    """Which problems.

    Parameters
    ----------
    seed : int
        Of the order in which they are run.
    families : mapping of str to int
        Number of problems of each.
    scenarios : tuple of str
        Those of whose steps problems are made: names, or files.
    source : str
        The set of problems that they are taken from: a name, or a folder; else they are made.
    most : mapping of str to float
        Where the dials of families end [the unit of each]; else at their hard ends.
    """

    __test__ = False  # no test of pytest's

    seed: int
    families: Mapping[str, int]
    scenarios: tuple[str, ...]
    source: str = ""
    most: Mapping[str, float] = field(default_factory=dict)


def study_problems(test_set: TestSet, study: str | Path, progress: bool = True) -> list[Problem]:
    """The problems of a test set: those in the folder of a study, or taken or made, and kept there.

    Parameters
    ----------
    test_set : TestSet
    study : str or Path
        The folder of the study.
    progress : bool
        Whether to show a bar on standard error, where that is a terminal.

    Raises
    ------
    InputError
        If the folder holds another test set.
    KeyboardInterrupt
        After Ctrl-C. Problems that were made by then are made again.
    """
    folder = Path(study) / FOLDER
    made_of = _made_of(test_set)
    if (folder / MANIFEST).exists():
        if manifest(folder).get("made_of") != json.loads(json_text(made_of)):
            words = "holds another test set; choose another folder with --out, or remove this one"
            raise InputError(words, file=folder)
        return set_read(folder)
    families = dict(test_set.families)
    made = {name: families.pop(name) for name in MADE if name in families}
    if test_set.source:
        problems = problems_taken(test_set.source, families, test_set.most)
    else:
        problems = problems_of_runs(test_set.scenarios, families.get(SCENARIOS, 0), progress)
    for name, count in made.items():
        problems += problems_of_boxes(name, count, test_set.most.get(name))
    set_written(folder, FOLDER, problems, made_of=made_of)
    return problems


def _made_of(test_set: TestSet) -> dict[str, Any]:
    """What tells one test set from another."""
    return {
        "seed": test_set.seed,
        "asked": dict(test_set.families),
        "scenarios": list(test_set.scenarios),
        "most": dict(test_set.most),
        "set": set_identity(test_set.source) if test_set.source else None,
    }


def problems_record(problems: Sequence[Problem]) -> dict[str, Any]:
    """How many problems of which family there are, and their fingerprint."""
    digest = hashlib.sha256()
    for one in problems:
        for numbers in (one.H.toarray(), one.g, one.A.toarray(), one.b, one.answer.x):
            digest.update((numbers + 0.0).tobytes())
        digest.update(json_text({str(k): v for k, v in one.answer.farkas.items()}).encode())
    return {
        "count": len(problems),
        "exact": sum(fact_of(one)["kind"] == "exact" for one in problems),
        "families": dict(Counter(one.facts["family"] for one in problems)),
        "sha256": digest.hexdigest(),
    }


def fact_of(problem: Problem) -> dict[str, Any]:
    """What a store keeps of a problem."""
    facts = problem.facts
    answer = problem.answer
    names = ("id", "family", "contacts", "mass_ratio", "h", "k", "n", "m")
    sequence = facts["sequence"] or {}
    return {
        **{name: facts[name] for name in names},
        **{name: facts["measures"][name] for name in ("condition", "condition_natural")},
        "kind": answer.kind if problem.feasible else INFEASIBLE,
        "bound": answer.error,
        "sequence": sequence.get("name"),
        "place": sequence.get("place"),
    }
