"""The problems of a study: taken from a set, or made of steps, and kept in its folder."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from quasistatic_ref.lab.study.problems.dials import SCENARIOS
from quasistatic_ref.lab.study.problems.folder import MANIFEST, set_read, set_written
from quasistatic_ref.lab.study.problems.making import problems_of_runs
from quasistatic_ref.lab.study.problems.problem import Problem
from quasistatic_ref.lab.study.problems.selection import problems_taken

FOLDER = "problems"
"""Within that of a study."""


@dataclass(frozen=True)
class TestSet:
    """Which problems.

    Parameters
    ----------
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

    families: Mapping[str, int]
    scenarios: tuple[str, ...]
    source: str = ""
    most: Mapping[str, float] = field(default_factory=dict)


def study_problems(test_set: TestSet, study: str | Path, progress: bool = True) -> list[Problem]:
    """The problems of a test set: taken from a set, or made once and kept in a study's folder.

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
        If a family is not there, a scenario is unusable, or the folder holds something else.
    KeyboardInterrupt
        After Ctrl-C. Problems that were made by then are made again.
    """
    if test_set.source:
        return problems_taken(test_set.source, test_set.families, test_set.most)
    folder = Path(study) / FOLDER
    if not (folder / MANIFEST).exists():
        count = test_set.families[SCENARIOS]
        set_written(folder, FOLDER, problems_of_runs(test_set.scenarios, count, progress))
    return set_read(folder)
